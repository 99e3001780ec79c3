#include "fleetmap/sim/imu_spec.hpp"

#include "sim/spec_bounds.hpp"

namespace fleetmap::sim {
namespace {

TEST(ImuSpec, FieldsHaveBounds) {
  expect_bounds<ImuSpec>({}, {{"rate", &ImuSpec::rate, 1.0, 2000.0},
                              {"gyro_noise", &ImuSpec::gyro_noise, 0.0, 1.0},
                              {"accel_noise", &ImuSpec::accel_noise, 0.0, 10.0},
                              {"gyro_bias_sigma", &ImuSpec::gyro_bias_sigma, 0.0, 1.0},
                              {"accel_bias_sigma", &ImuSpec::accel_bias_sigma, 0.0, 10.0},
                              {"gyro_bias_walk", &ImuSpec::gyro_bias_walk, 0.0, 1.0},
                              {"accel_bias_walk", &ImuSpec::accel_bias_walk, 0.0, 10.0},
                              {"gravity", &ImuSpec::gravity, 0.0, 30.0},
                              {"tilt_sigma", &ImuSpec::tilt_sigma, 0.0, 1.0},
                              {"heading_sigma", &ImuSpec::heading_sigma, 0.0, 3.2},
                              {"heading_correlation_time", &ImuSpec::heading_correlation_time, 1e-3, 1e6}});
}

}  // namespace
}  // namespace fleetmap::sim
