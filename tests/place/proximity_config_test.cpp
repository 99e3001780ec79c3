#include "fleetmap/place/proximity_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::place {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = ProximityConfig;

TEST(ProximityConfig, RadiiAreFiniteAndOrdered) {
  const Config config;
  expect_accepted(config, &Config::radius_scale, {1e-6, 1e6});
  expect_refused(config, &Config::radius_scale, {0.0, -1.0, kNaN<double>, kInfinity<double>}, "radius_scale");
  expect_accepted(config, &Config::min_radius, {0.0, config.max_radius});
  expect_refused(config, &Config::min_radius, {-0.1, kNaN<double>, kInfinity<double>}, "min_radius");
  expect_accepted(config, &Config::max_radius, {config.min_radius});
  expect_refused(config, &Config::max_radius, {config.min_radius - 0.1, kNaN<double>, kInfinity<double>},
                 "max_radius");
}

TEST(ProximityConfig, UncertaintiesHaveTheNamesOfTheConfiguration) {
  EXPECT_STREQ(to_string(Uncertainty::variance), "variance");
  EXPECT_STREQ(to_string(Uncertainty::sigma), "sigma");
}

}  // namespace
}  // namespace fleetmap::place
