#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/sim/gps_spec.hpp"
#include "fleetmap/sim/imu_spec.hpp"
#include "fleetmap/sim/lidar_spec.hpp"
#include "fleetmap/sim/vehicle_spec.hpp"
#include "fleetmap/sim/wheel_spec.hpp"

namespace fleetmap::sim {

/// One robot of the twin: chassis, sensors and their mounts.
struct RobotTwinConfig {
  LidarSpec lidar;
  Pose T_base_lidar = Pose::Identity();
  ImuSpec imu;
  Pose T_base_imu = Pose::Identity();
  GpsSpec gps;
  Eigen::Vector3d p_base_antenna = Eigen::Vector3d::Zero();  ///< m
  WheelSpec wheels;
  VehicleSpec vehicle;
  bool has_start = false;  ///< else the set-up of the team selects start and start_yaw
  Eigen::Vector2d start = Eigen::Vector2d::Zero();  ///< ENU, m
  double start_yaw = 0.0;                           ///< rad, from east, counter-clockwise
  bool guided = false;     ///< its driver gets the true pose, as a person who walks beside the robot would
  std::uint64_t seed = 1;  ///< of all this robot's randomness
  /// Fails with the section, the field and the rule that it breaks.
  Status validate() const;
};

}  // namespace fleetmap::sim
