#include "fleetmap/sim/gps_spec.hpp"

#include "sim/spec_bounds.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

TEST(GpsSpec, FieldsHaveBounds) {
  expect_bounds<GpsSpec>({}, {{"rate", &GpsSpec::rate, 0.05, 100.0},
                              {"white_sigma", &GpsSpec::white_sigma, 0.0, 1e3},
                              {"drift_sigma", &GpsSpec::drift_sigma, 0.0, 1e3},
                              {"correlation_time", &GpsSpec::correlation_time, 1e-3, 1e6},
                              {"vertical_factor", &GpsSpec::vertical_factor, 0.0, 100.0},
                              {"covariance_factor", &GpsSpec::covariance_factor, 0.0, 1e6},
                              {"jumps_per_hour", &GpsSpec::jumps_per_hour, 0.0, 3600.0},
                              {"jump_size", &GpsSpec::jump_size, 0.0, 1e4},
                              {"jump_duration", &GpsSpec::jump_duration, 0.0, 1e5},
                              {"altitude_wave", &GpsSpec::altitude_wave, 0.0, 1e4},
                              {"altitude_period", &GpsSpec::altitude_period, 1.0, 1e6}});
}

TEST(GpsSpec, OutagesHaveALengthAndLieInTheRun) {
  GpsSpec spec;
  spec.outages = {{0.0, 0.1}, {5.0, 50.0}};
  EXPECT_TRUE(spec.validate());
  for (const GpsOutage wrong : {GpsOutage{5.0, 5.0}, GpsOutage{5.0, 4.0}, GpsOutage{-1.0, 4.0},
                                GpsOutage{std::nan(""), 4.0}, GpsOutage{0.0, std::nan("")}}) {
    spec.outages = {{0.0, 1.0}, wrong};
    ASSERT_FALSE(spec.validate()) << wrong.from << ' ' << wrong.until;
    EXPECT_THAT(spec.validate().error().message, HasSubstr("0 <= from < until"));
  }
}

}  // namespace
}  // namespace fleetmap::sim
