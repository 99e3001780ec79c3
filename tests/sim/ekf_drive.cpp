#include "sim/ekf_drive.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "fleetmap/localization/ekf.hpp"
#include "fleetmap/sim/solar_farm.hpp"

namespace fleetmap::sim::testing {

EkfDrive::EkfDrive() {
  SolarFarmConfig farm;
  farm.size_east = farm.size_north = 100.0;
  world = make_solar_farm(farm).value();
  const Aisle& aisle = world->aisles()[world->aisles().size() / 2];
  const Eigen::Vector2d along = (aisle.to - aisle.from).normalized();
  robot.lidar = vlp16_spec();
  robot.T_base_imu = make_pose(rotation_from_rpy(0.1, 0.0, 1.2), {0.1, 0.05, 0.1});
  robot.p_base_antenna = {-0.1, 0.1, 0.5};
  robot.start = aisle.from + 10.0 * along;
  robot.start_yaw = std::atan2(along.y(), along.x());
}

namespace {

/// Adds the squares of the errors of G.
void add_errors(const Pose& T_enu_base, const LocalFrame& site, const GlobalPose& G, EkfErrors& errors) {
  const Pose estimate = pose_in(site, G);
  const Eigen::Vector3d error = estimate.translation() - T_enu_base.translation();
  const double yaw = so3_log(estimate.linear() * T_enu_base.linear().transpose()).z();
  errors.horizontal += error.head<2>().squaredNorm();
  errors.height += error.z() * error.z();
  errors.heading += yaw * yaw;
  errors.nees_horizontal +=
      error.head<2>().dot(G.covariance.topLeftCorner<2, 2>().inverse() * error.head<2>()) / 2.0;
  errors.nees_up += error.z() * error.z() / G.covariance(2, 2);
  errors.nees_yaw += yaw * yaw / G.covariance(5, 5);
  ++errors.poses;
}

/// Makes means and RMS of the sums.
void average(EkfErrors& errors, int fixes) {
  const auto over = [](double& sum, int count) { sum /= std::max(1, count); };
  for (double* sum : {&errors.horizontal, &errors.height, &errors.heading, &errors.nees_horizontal,
                      &errors.nees_up, &errors.nees_yaw})
    over(*sum, errors.poses);
  over(errors.fixes_horizontal, fixes);
  for (double* square : {&errors.horizontal, &errors.height, &errors.heading, &errors.fixes_horizontal})
    *square = std::sqrt(*square);
}

}  // namespace

EkfErrors run(const EkfDrive& drive, std::uint64_t seed) {
  RobotTwinConfig robot = drive.robot;
  robot.seed = seed;
  const GeoPoint origin = geo_point_from_degrees(49, 8.4, 100);
  const LocalFrame site(origin);
  RobotTwin twin = RobotTwin::create(drive.world, origin, robot, Stamp{}).value();
  localization::EkfConfig config = drive.ekf;
  config.site_origin = origin;
  if (drive.knows_imu_mount) config.mounting.T_base_imu = robot.T_base_imu;
  if (drive.knows_antenna) config.mounting.p_base_antenna = robot.p_base_antenna;
  localization::Ekf ekf(config);
  EkfErrors errors;
  int fixes = 0;
  for (int k = 1; k <= static_cast<int>(10.0 * drive.seconds); ++k) {
    const bool turning = (k / 100) % 3 == 2;
    twin.command(turning ? 0.0 : 1.2, turning ? 0.314159 : 0.1 * std::cos(0.2 * k));
    for (const TwinSample& sample : twin.advance(Stamp{k * std::chrono::milliseconds(100)})) {
      if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
        ekf.add(*imu);
        errors.worst_force = std::max(errors.worst_force, std::abs(imu->specific_force.norm() - 9.80665));
        errors.worst_turn = std::max(errors.worst_turn, imu->angular_velocity.norm());
      }
      if (const auto* fix = std::get_if<sensor::Fix>(&sample)) {
        ekf.add(*fix);
        const Eigen::Vector3d p_enu_antenna = twin.T_enu_base() * robot.p_base_antenna;
        errors.fixes_horizontal += (site.to_enu(fix->position) - p_enu_antenna).head<2>().squaredNorm();
        ++fixes;
      }
      if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) ekf.add(*wheel);
    }
    const auto pose = ekf.pose();
    if (k >= 200 && pose) add_errors(twin.T_enu_base(), site, *pose, errors);
  }
  average(errors, fixes);
  return errors;
}

}  // namespace fleetmap::sim::testing
