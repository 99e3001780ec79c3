#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// Rate, noise and biases of the twin's IMU.
struct ImuSpec {
  double rate = 100.0;             ///< Hz
  double gyro_noise = 1e-3;        ///< rad/s/sqrt(Hz)
  double accel_noise = 1e-2;       ///< m/s^2/sqrt(Hz)
  double gyro_bias_sigma = 3e-3;   ///< rad/s, at start
  double accel_bias_sigma = 5e-2;  ///< m/s^2, at start
  double gyro_bias_walk = 2e-5;    ///< rad/s/sqrt(s)
  double accel_bias_walk = 2e-4;   ///< m/s^2/sqrt(s)
  double gravity = 9.80665;        ///< m/s^2
  bool reports_orientation = true;
  double tilt_sigma = 0.01;                 ///< rad, of each orientation, white
  double heading_sigma = 0.05;              ///< rad, of the magnetic heading, drifting slowly
  double heading_correlation_time = 120.0;  ///< s
  Status validate() const;
};

}  // namespace fleetmap::sim
