#pragma once

#include <cstdint>
#include <memory>

#include "fleetmap/localization/ekf_config.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::sim::testing {

/// A robot of the twin in a lane of a solar farm, its IMU turned and its antenna off base_link.
struct EkfDrive {
  EkfDrive();
  std::shared_ptr<const World> world;
  RobotTwinConfig robot;
  localization::EkfConfig ekf;  ///< mounts and origin are set by run()
  bool knows_antenna = true;    ///< else it takes the fixes for those of base_link
  bool knows_imu_mount = true;  ///< else it takes the IMU's axes for those of base_link
  double seconds = 90.0;        ///< s; errors count after the first 20
};

/// Errors of the EKF against the truth: RMS, and NEES as its mean over time and dimensions.
struct EkfErrors {
  double horizontal = 0.0, height = 0.0;  ///< m
  double heading = 0.0;                   ///< rad
  double nees_horizontal = 0.0, nees_up = 0.0, nees_yaw = 0.0;
  double fixes_horizontal = 0.0;               ///< m, of the fixes themselves
  double worst_force = 0.0, worst_turn = 0.0;  ///< of the IMU, m/s^2 off gravity and rad/s
  int poses = 0;                               ///< compared, ten a second
};

/// Drives up and down, with turns on the spot, and gives the EKF what IMU, wheels and GPS measure.
EkfErrors run(const EkfDrive& drive, std::uint64_t seed);

}  // namespace fleetmap::sim::testing
