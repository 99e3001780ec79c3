// Measures a whole agent (perception, nodes, store, exchange, placement, files) over a day in virtual time,
// with scans of few points: memory, CPU and files for each thousand nodes, and how they grow over the second
// half. One robot, without loop closures; bench_endurance has the exchange and the candidates of several.
//   bench_agent_endurance [NODES [MINUTES]]    24000 nodes (24 hours), or as many as this computes in 25
//   minutes
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "agent/lapping_robot.hpp"
#include "bench/process_use.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "store/items.hpp"

namespace {

using namespace fleetmap;
using bench::files_mb;
using bench::resident_mb;
using testing::LappingRobot;

constexpr std::size_t kSlice = 1000;  // nodes

/// After a slice of nodes; CPU since the one before.
struct Row {
  double nodes = 0.0, hours = 0.0, all_ms = 0.0, odometry_ms = 0.0, placement_ms = 0.0, mb = 0.0;
};

void print(const Row& row, const std::filesystem::path& folder) {
  std::printf("| %.0f | %.1f | %.1f, %.1f, %.1f | %.1f | %.1f, %.1f | %.1f |\n", row.nodes, row.hours,
              row.all_ms, row.odometry_ms, row.placement_ms, row.mb, files_mb(folder, ".db"),
              files_mb(folder, ".db-wal"), files_mb(folder, ".tum") + files_mb(folder, ".csv"));
  std::fflush(stdout);
}

/// Least squares: growth of `value` a node.
template <class Value>
double slope(const std::vector<Row>& rows, Value value) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Row& row : rows) {
    n += 1.0, x += row.nodes, y += value(row), xx += row.nodes * row.nodes, xy += row.nodes * value(row);
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void measure(std::size_t nodes, double minutes) {
  const testing::TemporaryFolder folder;
  LappingRobot robot({.scan_rate = 1.0, .columns = 300, .folder = folder / "r1"});
  std::printf(
      "| own nodes | hours | CPU ms a node: all, odometry, placement | RSS MB | store, its log MB | tracks "
      "MB |\n|---|---|---|---|---|---|\n");
  const auto begun = std::chrono::steady_clock::now();
  std::vector<Row> rows;
  agent::WorkSeconds work;
  double cpu = process_cpu_seconds(), hours = 0.0;
  for (std::size_t at = kSlice; at <= nodes; at += kSlice) {
    while (robot.agent().store().nodes().size() < at) {
      robot.run_for(LappingRobot::kLap);
      robot.forget_errors();
      hours += LappingRobot::kLap / 3600.0;
    }
    const agent::WorkSeconds now = robot.agent().work_seconds();
    const double per_node = 1e3 / kSlice;
    rows.push_back({static_cast<double>(at), hours, per_node * (process_cpu_seconds() - cpu),
                    per_node * (now.odometry - work.odometry), per_node * (now.placement - work.placement),
                    resident_mb()});
    cpu = process_cpu_seconds();
    work = now;
    print(rows.back(), folder / "r1");
    if (std::chrono::steady_clock::now() - begun > std::chrono::duration<double, std::ratio<60>>(minutes))
      break;
  }
  if (rows.size() < 4) return;
  rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2));
  std::printf("second half: %.2f kB a node, CPU %+.2f ms a node in 1000 nodes\n",
              1e3 * slope(rows, [](const Row& row) { return row.mb; }),
              1e3 * slope(rows, [](const Row& row) { return row.all_ms; }));
}

}  // namespace

int main(int argc, char** argv) {
  measure(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 24'000,
          argc > 2 ? std::strtod(argv[2], nullptr) : 25.0);
}
