#include "fleetmap/sim/vehicle_spec.hpp"

#include "spec_rules.hpp"

namespace fleetmap::sim {

Status VehicleSpec::validate() const {
  return first_failure({
      within("max_speed", max_speed, 0.01, 50.0, "m/s"),
      within("acceleration", acceleration, 0.01, 50.0, "m/s^2"),
      within("max_yaw_rate", max_yaw_rate, 0.01, 20.0, "rad/s"),
      within("yaw_acceleration", yaw_acceleration, 0.01, 200.0, "rad/s^2"),
      within("lag", lag, 0.0, 5.0, "s"),
      within("radius", radius, 0.05, 5.0, "m"),
      within("base_height", base_height, 0.0, 3.0, "m"),
      within("wheelbase", wheelbase, 0.05, 5.0, "m"),
      within("suspension_rate", suspension_rate, 0.2, 10.0, "Hz"),
      within("suspension_damping", suspension_damping, 0.1, 2.0, "(a ratio)"),
      within("braking", braking, 0.5, 100.0, "m/s^2"),
      within("command_timeout", command_timeout, 0.0, 1e4, "s"),
      within("battery_wh", battery_wh, 0.0, 1e6, "Wh"),
      within("idle_power_w", idle_power_w, 0.0, 1e5, "W"),
      within("energy_per_metre", energy_per_metre, 0.0, 1e5, "J/m"),
      within("energy_per_radian", energy_per_radian, 0.0, 1e5, "J/rad"),
  });
}

}  // namespace fleetmap::sim
