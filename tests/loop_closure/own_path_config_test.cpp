#include "fleetmap/loop_closure/own_path_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::loop_closure {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(OwnPathConfig, DefaultsAreValid) { EXPECT_TRUE(OwnPathConfig{}.validate()); }

TEST(OwnPathConfig, TheReachIsPositiveAndThePathTwiceAsLong) {
  const OwnPathConfig config;
  expect_accepted(config, &OwnPathConfig::reach, {1e-3, 0.5 * config.min_path});
  expect_refused(config, &OwnPathConfig::reach, {0.0, -1.0, kNaN<double>, kInfinity<double>},
                 "own_path.reach");
  expect_refused(config, &OwnPathConfig::reach, {0.5 * config.min_path + 0.1}, "own_path.min_path");
  expect_refused(config, &OwnPathConfig::min_path,
                 {2.0 * config.reach - 0.1, kNaN<double>, kInfinity<double>}, "own_path.min_path");
}

TEST(OwnPathConfig, TheSpacingIsFiniteAndNotNegative) {
  expect_accepted(OwnPathConfig{}, &OwnPathConfig::spacing, {0.0});
  expect_refused(OwnPathConfig{}, &OwnPathConfig::spacing, {-0.1, kNaN<double>, kInfinity<double>},
                 "own_path.spacing");
}

}  // namespace
}  // namespace fleetmap::loop_closure
