// CPU of the fleet's robust pose graph: fleetmap's canonical batch solution at several sizes, and what the
// paper's scheme takes on the same set in the same run.

#include <cstdio>
#include <limits>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/graph/fleet_placement.hpp"
#include "graph/simulated_fleet.hpp"

namespace {

using namespace fleetmap;
using graph::testing::SimulatedFleet;

template <class Run>
double best_of(int times, const Run& run) {
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < times; ++k) {
    const double start = thread_cpu_seconds();
    run();
    best = std::min(best, thread_cpu_seconds() - start);
  }
  return best;
}

void measure(int robots, int nodes_each, int every, bool attacked) {
  graph::testing::SimulatedFleetConfig config;
  config.robots = robots;
  config.interleaved = true;
  config.lanes = std::max(1, static_cast<int>(nodes_each * config.spacing / (config.length + 6.0 * robots)));
  config.reach = 0.0;
  SimulatedFleet fleet(1, config);
  std::uint32_t last = 0;
  for (const graph::Node& node : fleet.nodes) last = std::max(last, node.id.seq);
  int k = 0;
  for (std::uint32_t seq = 0; seq <= last; seq += static_cast<std::uint32_t>(every)) {
    for (int r = 0; r + 1 < robots; ++r) {
      const bool wrong = attacked && ++k % 5 == 0;
      fleet.align({SimulatedFleet::agent(r), seq}, {SimulatedFleet::agent(r + 1), seq},
                  SimulatedFleet::agent(r), wrong ? Eigen::Vector3d(6.0, 0.0, 0.0) : Eigen::Vector3d::Zero());
    }
  }
  graph::Placement placement;
  const double fleet_s =
      best_of(3, [&] { placement = graph::place_by_fleet_graph(fleet.nodes, fleet.alignments, fleet.site); });
  const double paper_s =
      best_of(3, [&] { graph::place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site); });
  std::printf("| %zu | %d | %zu | %s | %zu | %.1f | %.1f | %.2f |\n", fleet.nodes.size(), robots,
              fleet.alignments.size(), attacked ? "1 in 5" : "none", placement.used.size(), 1e3 * fleet_s,
              1e3 * paper_s, fleet_s / paper_s);
}

}  // namespace

int main() {
  std::printf(
      "| nodes | robots | alignments | one row off | used | fleet, CPU ms | paper, CPU ms | ratio |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  measure(5, 200, 10, false);
  measure(5, 200, 10, true);
  measure(5, 2'000, 10, true);
  measure(10, 5'000, 20, false);
  measure(10, 5'000, 20, true);
  measure(10, 5'000, 10, true);
}
