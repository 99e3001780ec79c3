#include "fleetmap/sim/wheel_spec.hpp"

#include "spec_rules.hpp"

namespace fleetmap::sim {

Status WheelSpec::validate() const {
  return first_failure({
      within("rate", rate, 0.1, 1000.0, "Hz"),
      within("scale_sigma", scale_sigma, 0.0, 0.5, "(a share)"),
      within("yaw_scale_sigma", yaw_scale_sigma, 0.0, 0.5, "(a share)"),
      within("slip", slip, 0.0, 1.0, "(a share)"),
      within("slip_turning", slip_turning, 0.0, 1.0, "(a share per rad/s)"),
      within("slip_time", slip_time, 1e-3, 1e4, "s"),
      within("speed_noise", speed_noise, 0.0, 10.0, "m/s"),
      within("yaw_rate_noise", yaw_rate_noise, 0.0, 10.0, "rad/s"),
  });
}

}  // namespace fleetmap::sim
