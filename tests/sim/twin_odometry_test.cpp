// The odometry on what the twin's LiDAR measures. Bounds: docs/reference/test_bounds.md.
#include <gtest/gtest.h>

#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/solar_farm.hpp"
#include "support/measured.hpp"

namespace fleetmap::sim {
namespace {

struct Drive {
  double length = 0.0, error = 0.0, turn_error = 0.0;  ///< m; m and rad at the end
  double step = 0.0, step_turn = 0.0;                  ///< RMS error of the motion within a second, m and rad
  odometry::LoamCounters counters;
};

/// Compares poses of the same instants; the errors stay 0 if there are not as many of both.
void compare(const std::vector<Pose>& truth, const std::vector<Pose>& estimate, Drive& result) {
  if (estimate.size() != truth.size()) return;
  const auto error_between = [&](std::size_t i, std::size_t j) -> Pose {
    return (truth[i].inverse() * truth[j]).inverse() * (estimate[i].inverse() * estimate[j]);
  };
  const Pose error = error_between(0, truth.size() - 1);
  result.error = error.translation().norm();
  result.turn_error = so3_log(error.linear()).norm();
  const std::size_t steps = truth.size() - 10;
  for (std::size_t k = 0; k < steps; ++k) {
    const Pose step = error_between(k, k + 10);
    result.step += step.translation().squaredNorm() / static_cast<double>(steps);
    result.step_turn += so3_log(step.linear()).squaredNorm() / static_cast<double>(steps);
  }
  result.step = std::sqrt(result.step);
  result.step_turn = std::sqrt(result.step_turn);
}

/// The odometry alone along a lane of a farm: proves frames, rings and times of the twin's scans.
Drive along_an_aisle(const LidarSpec& lidar, const char* model, unsigned seed, bool deskew = true) {
  SolarFarmConfig farm;
  farm.size_east = farm.size_north = 100.0;
  farm.row_pitch = 8.0;
  farm.seed = seed;
  const auto world = make_solar_farm(farm).value();
  const auto scene = Scene::create(world->mesh()).value();
  const Aisle& aisle = world->aisles()[world->aisles().size() / 2];
  const Eigen::Vector2d along = (aisle.to - aisle.from).normalized();
  RobotTwinConfig config;
  config.lidar = lidar;
  config.seed = seed;
  config.T_base_lidar = make_pose(rotation_from_rpy(0.0, 0.02, 0.3), {0.1, 0.0, 0.4});
  config.start = aisle.from + 10.0 * along;
  config.start_yaw = std::atan2(along.y(), along.x());
  RobotTwin twin = RobotTwin::create(world, geo_point_from_degrees(49, 8, 100), config, Stamp{}).value();

  odometry::LoamConfig loam_config;
  loam_config.T_base_lidar = config.T_base_lidar;
  loam_config.deskew = deskew;
  odometry::Loam loam(loam_config, odometry::lidar_model(model).value());
  std::vector<Pose> truth{twin.T_enu_base()}, estimate;
  for (int k = 1; k <= 180; ++k) {
    twin.command(k > 5 ? 1.5 : 0.0, k > 20 ? 0.3 * std::cos(0.1 * (k - 20)) : 0.0);
    for (const TwinSample& sample : twin.advance(Stamp{k * std::chrono::milliseconds(100)})) {
      const auto* job = std::get_if<ScanJob>(&sample);
      if (job == nullptr) continue;
      const auto update = loam.add_scan(cast_scan(*scene, lidar, *job));
      if (update) estimate.push_back(update->T_odom_base);
    }
    truth.push_back(twin.T_enu_base());
  }
  truth.pop_back();
  Drive result;
  result.length = twin.odometer();
  result.counters = loam.counters();
  compare(truth, estimate, result);
  EXPECT_FALSE(twin.touching());
  return result;
}

struct Bounds {
  double per_cent, turn;   ///< at the end: per cent of the length, rad
  double step, step_turn;  ///< within a second: m, rad
};
constexpr Bounds kVlp16{0.20, 0.0032, 0.0035, 0.0010}, kNonRepeating{0.51, 0.0055, 0.0119, 0.0011};

void expect_true_to(const LidarSpec& lidar, const char* model, const Bounds& bounds) {
  for (unsigned seed = 1; seed <= fleetmap::testing::seeds_to_run(2); ++seed) {
    const Drive drive = along_an_aisle(lidar, model, seed);
    EXPECT_GT(drive.length, 23.0);
    EXPECT_EQ(drive.counters.updates, 180u);
    EXPECT_EQ(drive.counters.lost, 0u);
    EXPECT_EQ(drive.counters.rings_ignored, 0u);
    EXPECT_EQ(drive.counters.points_bad_time, 0u);
    const std::string of = std::string("odometry, ") + model;
    fleetmap::testing::expect_at_most(100.0 * drive.error / drive.length, bounds.per_cent, of + ", per cent",
                                      seed);
    fleetmap::testing::expect_at_most(drive.turn_error, bounds.turn, of + ", rad", seed);
    fleetmap::testing::expect_at_most(drive.step, bounds.step, of + ", m within a second", seed);
    fleetmap::testing::expect_at_most(drive.step_turn, bounds.step_turn, of + ", rad within a second", seed);
  }
}

TEST(TwinOdometry, Vlp16StaysTrueAlongAnAisle) { expect_true_to(vlp16_spec(), "vlp16", kVlp16); }

TEST(TwinOdometry, NonRepeatingScannerStaysTrueAlongAnAisle) {
  LidarSpec spec;
  spec.pattern = FiringPattern::kNonRepeating;
  spec.rays = 10000;
  expect_true_to(spec, "generic", kNonRepeating);
}

/// The bounds are so tight that scans which are not corrected for the motion within them break them.
TEST(TwinOdometry, WithoutDeskewingTheBoundsAreBroken) {
  for (unsigned seed = 1; seed <= fleetmap::testing::seeds_to_run(1); ++seed) {
    const Drive drive = along_an_aisle(vlp16_spec(), "vlp16", seed, false);
    fleetmap::testing::expect_at_least(drive.step, kVlp16.step, "odometry not de-skewed, m within a second",
                                       seed);
    fleetmap::testing::expect_at_least(drive.step_turn, kVlp16.step_turn,
                                       "odometry not de-skewed, rad within a second", seed);
  }
}

}  // namespace
}  // namespace fleetmap::sim
