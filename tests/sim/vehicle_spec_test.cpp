#include "fleetmap/sim/vehicle_spec.hpp"

#include "sim/spec_bounds.hpp"

namespace fleetmap::sim {
namespace {

TEST(VehicleSpec, FieldsHaveBounds) {
  expect_bounds<VehicleSpec>({}, {{"max_speed", &VehicleSpec::max_speed, 0.01, 50.0},
                                  {"acceleration", &VehicleSpec::acceleration, 0.01, 50.0},
                                  {"max_yaw_rate", &VehicleSpec::max_yaw_rate, 0.01, 20.0},
                                  {"yaw_acceleration", &VehicleSpec::yaw_acceleration, 0.01, 200.0},
                                  {"lag", &VehicleSpec::lag, 0.0, 5.0},
                                  {"radius", &VehicleSpec::radius, 0.05, 5.0},
                                  {"base_height", &VehicleSpec::base_height, 0.0, 3.0},
                                  {"wheelbase", &VehicleSpec::wheelbase, 0.05, 5.0},
                                  {"suspension_rate", &VehicleSpec::suspension_rate, 0.2, 10.0},
                                  {"suspension_damping", &VehicleSpec::suspension_damping, 0.1, 2.0},
                                  {"braking", &VehicleSpec::braking, 0.5, 100.0},
                                  {"command_timeout", &VehicleSpec::command_timeout, 0.0, 1e4},
                                  {"battery_wh", &VehicleSpec::battery_wh, 0.0, 1e6},
                                  {"idle_power_w", &VehicleSpec::idle_power_w, 0.0, 1e5},
                                  {"energy_per_metre", &VehicleSpec::energy_per_metre, 0.0, 1e5},
                                  {"energy_per_radian", &VehicleSpec::energy_per_radian, 0.0, 1e5}});
}

}  // namespace
}  // namespace fleetmap::sim
