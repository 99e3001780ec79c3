#include <benchmark/benchmark.h>

#include "fleetmap/sim/lidar.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/solar_farm.hpp"

namespace fleetmap::sim {
namespace {

struct Farm {
  std::shared_ptr<const World> world;
  std::shared_ptr<const Scene> scene;
};

/// The generated farm of 200 m by 200 m.
const Farm& farm() {
  static const Farm made = [] {
    Farm f;
    f.world = make_solar_farm({}).value();
    f.scene = Scene::create(f.world->mesh()).value();
    return f;
  }();
  return made;
}

/// Poses of a scan in the middle of an aisle, at 1 m/s and 0.3 rad/s.
ScanJob job_in_an_aisle(std::uint64_t number) {
  const World& world = *farm().world;
  const Aisle& aisle = world.aisles()[world.aisles().size() / 2];
  const double share = 0.1 + 0.8 * static_cast<double>(number % 97) / 97.0;
  const Eigen::Vector2d p = aisle.from + share * (aisle.to - aisle.from);
  ScanJob job;
  job.number = number;
  job.step = std::chrono::milliseconds(5);
  for (int k = 0; k <= 20; ++k) {
    const double x = p.x() + 5e-3 * k;
    job.T_enu_lidar.push_back(make_pose(rotation_from_rpy(0.01, 0.01, 1.5e-3 * k),
                                        {x, p.y(), world.ground_height({x, p.y()}) + 0.6}));
  }
  return job;
}

void cast(benchmark::State& state, const LidarSpec& spec) {
  farm();
  std::uint64_t number = 0;
  std::size_t points = 0;
  for (auto _ : state) points += cast_scan(*farm().scene, spec, job_in_an_aisle(number++)).points.size();
  const double rays =
      spec.pattern == FiringPattern::kSpinning
          ? static_cast<double>(spec.columns) * static_cast<double>(spec.vertical_angles.size())
          : spec.rays;
  state.counters["rays/s"] =
      benchmark::Counter(rays * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["points/scan"] = static_cast<double>(points) / static_cast<double>(state.iterations());
}

void Vlp16(benchmark::State& state) { cast(state, vlp16_spec()); }
void Vlp16WithoutDivergence(benchmark::State& state) {
  LidarSpec spec = vlp16_spec();
  spec.beam_divergence = 0.0;
  cast(state, spec);
}
void Rings128(benchmark::State& state) {
  LidarSpec spec;
  spec.vertical_angles.clear();
  for (int ring = 0; ring < 128; ++ring) spec.vertical_angles.push_back(0.3927 * (1.0 - ring / 63.5));
  spec.columns = 1024;
  cast(state, spec);
}
void NonRepeating(benchmark::State& state) {
  LidarSpec spec;
  spec.pattern = FiringPattern::kNonRepeating;
  cast(state, spec);
}
BENCHMARK(Vlp16)->Unit(benchmark::kMillisecond);
BENCHMARK(Vlp16WithoutDivergence)->Unit(benchmark::kMillisecond);
BENCHMARK(Rings128)->Unit(benchmark::kMillisecond);
BENCHMARK(NonRepeating)->Unit(benchmark::kMillisecond);

/// Ten seconds of driving, all samples but no rays.
void Chassis(benchmark::State& state) {
  RobotTwinConfig config;
  config.lidar = vlp16_spec();
  const Aisle& aisle = farm().world->aisles().front();
  config.start = aisle.from;
  for (auto _ : state) {
    auto robot = RobotTwin::create(farm().world, geo_point_from_degrees(49, 8, 100), config, Stamp{}).value();
    for (int k = 1; k <= 100; ++k) {
      robot.command(1.0, 0.0);
      benchmark::DoNotOptimize(robot.advance(Stamp{k * std::chrono::milliseconds(100)}));
    }
  }
}
BENCHMARK(Chassis)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fleetmap::sim
