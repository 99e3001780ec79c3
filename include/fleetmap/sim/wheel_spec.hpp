#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// Rate, slip and noise of the twin's wheel odometry.
struct WheelSpec {
  double rate = 20.0;             ///< Hz
  double scale_sigma = 0.01;      ///< of the speed, constant for a robot: tyres
  double yaw_scale_sigma = 0.05;  ///< of the yaw rate, constant for a robot: the skid-steer's track
  double slip = 0.02;             ///< of the speed, 1 sigma going straight; comes and goes
  double slip_turning = 0.10;     ///< added to `slip` for each rad/s of yaw rate: a skid-steer scrubs
  double slip_time = 0.5;         ///< s, how long a slip lasts
  double speed_noise = 0.01;      ///< m/s, white
  double yaw_rate_noise = 0.02;   ///< rad/s, white
  bool reports_yaw_rate = true;
  Status validate() const;
};

}  // namespace fleetmap::sim
