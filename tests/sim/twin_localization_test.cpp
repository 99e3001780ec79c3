#include <gtest/gtest.h>

#include "fleetmap/localization/ekf.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/solar_farm.hpp"

namespace fleetmap::sim {
namespace {

/// The farm's robot drives up and down a lane; the EKF hears its IMU, wheels and GPS.
struct Estimate {
  double position = 0.0, heading = 0.0;  ///< rms m and rad, after the first 20 s
  double normalised = 0.0;               ///< mean squared Mahalanobis distance of the horizontal position
  double worst_force = 0.0, worst_turn = 0.0;  ///< of the IMU, m/s^2 off gravity and rad/s
};

Estimate drive(const std::shared_ptr<const World>& world, const RobotTwinConfig& base, std::uint64_t seed) {
  RobotTwinConfig config = base;
  config.seed = seed;
  const GeoPoint origin = geo_point_from_degrees(49, 8.4, 100);
  const LocalFrame site(origin);
  RobotTwin twin = RobotTwin::create(world, origin, config, Stamp{}).value();
  localization::EkfConfig ekf_config;
  ekf_config.site_origin = origin;
  ekf_config.mounting.T_base_imu = config.T_base_imu;
  ekf_config.mounting.p_base_antenna = config.p_base_antenna;
  localization::Ekf ekf(ekf_config);
  Estimate run;
  int count = 0;
  for (int k = 1; k <= 900; ++k) {
    const bool turning = (k / 100) % 3 == 2;
    twin.command(turning ? 0.0 : 1.2, turning ? 0.314159 : 0.1 * std::cos(0.2 * k));
    for (const TwinSample& sample : twin.advance(Stamp{k * std::chrono::milliseconds(100)})) {
      if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
        ekf.add(*imu);
        run.worst_force = std::max(run.worst_force, std::abs(imu->specific_force.norm() - 9.80665));
        run.worst_turn = std::max(run.worst_turn, imu->angular_velocity.norm());
      }
      if (const auto* fix = std::get_if<sensor::Fix>(&sample)) ekf.add(*fix);
      if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) ekf.add(*wheel);
    }
    const auto pose = ekf.pose();
    if (k < 200 || !pose) continue;
    const Pose estimate = pose_in(site, *pose);
    const Eigen::Vector3d error = estimate.translation() - twin.T_enu_base().translation();
    const Eigen::Matrix3d turn = estimate.linear() * twin.T_enu_base().linear().transpose();
    run.position += error.head<2>().squaredNorm();
    run.heading += std::pow(so3_log(turn).z(), 2);
    run.normalised += error.head<2>().dot(pose->covariance.topLeftCorner<2, 2>().inverse() * error.head<2>());
    ++count;
  }
  EXPECT_EQ(count, 701);
  run.position = std::sqrt(run.position / count);
  run.heading = std::sqrt(run.heading / count);
  run.normalised /= count;
  return run;
}

TEST(TwinLocalization, TheFilterBelievesTheTwinsSensorsAndIsRight) {
  SolarFarmConfig farm;
  farm.size_east = farm.size_north = 100.0;
  const auto world = make_solar_farm(farm).value();
  const Aisle& aisle = world->aisles()[world->aisles().size() / 2];
  const Eigen::Vector2d along = (aisle.to - aisle.from).normalized();
  RobotTwinConfig config;
  config.lidar = vlp16_spec();
  config.T_base_imu = make_pose(rotation_from_rpy(0.1, 0.0, 1.2), {0.1, 0.05, 0.1});
  config.p_base_antenna = {-0.1, 0.1, 0.5};
  config.start = aisle.from + 10.0 * along;
  config.start_yaw = std::atan2(along.y(), along.x());
  Estimate mean;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Estimate run = drive(world, config, seed);
    mean.position += run.position / kSeeds;
    mean.heading += run.heading / kSeeds;
    mean.normalised += run.normalised / kSeeds;
    EXPECT_LT(run.worst_force, 4.0);
    EXPECT_LT(run.worst_turn, 1.0);
  }
  EXPECT_LT(mean.position, 2.0);  // GPS alone: 1.5 m
  EXPECT_LT(mean.heading, 0.1);
  EXPECT_LT(mean.normalised, 4.0);  // 2 if the covariance is the error's
  EXPECT_GT(mean.normalised, 0.2);
}

}  // namespace
}  // namespace fleetmap::sim
