#include <gtest/gtest.h>

#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/solar_farm.hpp"

namespace fleetmap::sim {
namespace {

struct Drive {
  double length = 0.0, error = 0.0, turn_error = 0.0;
  odometry::LoamCounters counters;
};

/// The odometry alone along a lane of a farm: proves frames, rings and times of the twin's scans.
Drive along_an_aisle(const LidarSpec& lidar, const char* model, double yaw_rate) {
  SolarFarmConfig farm;
  farm.size_east = farm.size_north = 100.0;
  farm.row_pitch = 8.0;
  const auto world = make_solar_farm(farm).value();
  const auto scene = Scene::create(world->mesh()).value();
  const Aisle& aisle = world->aisles()[world->aisles().size() / 2];
  const Eigen::Vector2d along = (aisle.to - aisle.from).normalized();
  RobotTwinConfig config;
  config.lidar = lidar;
  config.T_base_lidar = make_pose(rotation_from_rpy(0.0, 0.02, 0.3), {0.1, 0.0, 0.4});
  config.start = aisle.from + 10.0 * along;
  config.start_yaw = std::atan2(along.y(), along.x());
  RobotTwin twin = RobotTwin::create(world, geo_point_from_degrees(49, 8, 100), config, Stamp{}).value();

  odometry::LoamConfig loam_config;
  loam_config.T_base_lidar = config.T_base_lidar;
  odometry::Loam loam(loam_config, odometry::lidar_model(model).value());
  std::vector<Pose> truth{twin.T_enu_base()}, estimate;
  for (int k = 1; k <= 180; ++k) {
    twin.command(k > 5 ? 1.5 : 0.0, k > 20 ? yaw_rate * std::cos(0.1 * (k - 20)) : 0.0);
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
  if (estimate.size() != truth.size()) return result;
  const Pose error =
      (truth.front().inverse() * truth.back()).inverse() * (estimate.front().inverse() * estimate.back());
  result.error = error.translation().norm();
  result.turn_error = so3_log(error.linear()).norm();
  EXPECT_FALSE(twin.touching());
  return result;
}

void expect_true_to(const Drive& drive, double share) {
  EXPECT_GT(drive.length, 23.0);
  EXPECT_EQ(drive.counters.updates, 180u);
  EXPECT_EQ(drive.counters.lost, 0u);
  EXPECT_EQ(drive.counters.rings_ignored, 0u);
  EXPECT_EQ(drive.counters.points_bad_time, 0u);
  EXPECT_LT(drive.error, share * drive.length);
  EXPECT_LT(drive.turn_error, 0.01);
}

TEST(TwinOdometry, Vlp16StaysTrueAlongAnAisle) {
  expect_true_to(along_an_aisle(vlp16_spec(), "vlp16", 0.3), 0.01);
}

TEST(TwinOdometry, NonRepeatingScannerStaysTrueAlongAnAisle) {
  LidarSpec spec;
  spec.pattern = FiringPattern::kNonRepeating;
  spec.rays = 10000;
  expect_true_to(along_an_aisle(spec, "generic", 0.3), 0.01);
}

}  // namespace
}  // namespace fleetmap::sim
