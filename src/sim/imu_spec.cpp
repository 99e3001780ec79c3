#include "fleetmap/sim/imu_spec.hpp"

#include "spec_rules.hpp"

namespace fleetmap::sim {

Status ImuSpec::validate() const {
  return first_failure({
      within("rate", rate, 1.0, 2000.0, "Hz"),
      within("gyro_noise", gyro_noise, 0.0, 1.0, "rad/s/sqrt(Hz)"),
      within("accel_noise", accel_noise, 0.0, 10.0, "m/s^2/sqrt(Hz)"),
      within("gyro_bias_sigma", gyro_bias_sigma, 0.0, 1.0, "rad/s"),
      within("accel_bias_sigma", accel_bias_sigma, 0.0, 10.0, "m/s^2"),
      within("gyro_bias_walk", gyro_bias_walk, 0.0, 1.0, "rad/s/sqrt(s)"),
      within("accel_bias_walk", accel_bias_walk, 0.0, 10.0, "m/s^2/sqrt(s)"),
      within("gravity", gravity, 0.0, 30.0, "m/s^2"),
      within("tilt_sigma", tilt_sigma, 0.0, 1.0, "rad"),
      within("heading_sigma", heading_sigma, 0.0, 3.2, "rad"),
      within("heading_correlation_time", heading_correlation_time, 1e-3, 1e6, "s"),
  });
}

}  // namespace fleetmap::sim
