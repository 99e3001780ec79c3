#include "fleetmap/sim/wheel_spec.hpp"

#include "sim/spec_bounds.hpp"

namespace fleetmap::sim {
namespace {

TEST(WheelSpec, FieldsHaveBounds) {
  expect_bounds<WheelSpec>({}, {{"rate", &WheelSpec::rate, 0.1, 1000.0},
                                {"scale_sigma", &WheelSpec::scale_sigma, 0.0, 0.5},
                                {"yaw_scale_sigma", &WheelSpec::yaw_scale_sigma, 0.0, 0.5},
                                {"slip", &WheelSpec::slip, 0.0, 1.0},
                                {"slip_turning", &WheelSpec::slip_turning, 0.0, 1.0},
                                {"slip_time", &WheelSpec::slip_time, 1e-3, 1e4},
                                {"speed_noise", &WheelSpec::speed_noise, 0.0, 10.0},
                                {"yaw_rate_noise", &WheelSpec::yaw_rate_noise, 0.0, 10.0}});
}

}  // namespace
}  // namespace fleetmap::sim
