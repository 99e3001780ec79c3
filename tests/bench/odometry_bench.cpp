// CPU time of LOAM per scan and of each of its stages, driving through a generated yard.
#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "fleetmap/odometry/loam.hpp"
#include "support/synthetic_lidar.hpp"

namespace {

using namespace fleetmap;

void drive(benchmark::State& state, odometry::LidarModel model, bool rings) {
  testing::ScanOptions options;
  options.has_ring = rings;
  if (model.name == "hdl64e") {  // fired column by column here, not stored ring by ring
    model.ring_source = odometry::RingSource::kElevation;
    model.stamp_phase = 0.0;
    options.T_base_lidar.translation().z() = 1.7;
  }
  const testing::SyntheticWorld world = testing::yard_world();
  const testing::SyntheticDrive motion({{0.5, 0, 0}, {6, 1.5, 0}, {2, 1.0, 0.5}, {2, 0, -0.8}});
  std::vector<sensor::Scan> scans;
  double points = 0.0;
  for (double t = 0.0; t + 0.1 < motion.duration(); t += 0.1) {
    scans.push_back(make_scan(
        world, [&](double s) { return motion.at(s); }, t, model, options));
    points += static_cast<double>(scans.back().points.size());
  }
  odometry::LoamConfig config;
  config.T_base_lidar = options.T_base_lidar;
  std::map<std::string, double> stages;
  for (auto _ : state) {
    odometry::Loam loam(config, model);
    for (const sensor::Scan& scan : scans) benchmark::DoNotOptimize(loam.add_scan(scan));
    for (const auto& [stage, seconds] : loam.counters().cpu.named()) stages[stage] += seconds;
  }
  const auto done = static_cast<double>(scans.size()) * static_cast<double>(state.iterations());
  for (const auto& [stage, seconds] : stages) state.counters[stage + "_ms"] = 1e3 * seconds / done;
  state.counters["s_per_scan"] =
      benchmark::Counter(done, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["points"] = points / static_cast<double>(scans.size());
}

BENCHMARK_CAPTURE(drive, vlp16, odometry::vlp16(), true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drive, vlp16_rings_recovered, odometry::vlp16(), false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drive, os1_64, odometry::os1_64(), true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drive, hdl64e, odometry::hdl64e(), true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(drive, non_repeating, odometry::generic_lidar(), false)->Unit(benchmark::kMillisecond);

}  // namespace
