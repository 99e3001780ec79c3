#pragma once

#include "fleetmap/sim/imu.hpp"

namespace fleetmap::sim {

/// An IMU without noise, biases and errors of its attitude.
inline ImuSpec perfect_imu() {
  ImuSpec spec;
  spec.gyro_noise = spec.accel_noise = spec.gyro_bias_sigma = spec.accel_bias_sigma = 0.0;
  spec.gyro_bias_walk = spec.accel_bias_walk = spec.tilt_sigma = spec.heading_sigma = 0.0;
  return spec;
}

}  // namespace fleetmap::sim
