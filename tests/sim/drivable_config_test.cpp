#include "fleetmap/sim/drivable_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(DrivableConfig, LengthsAndSlopesAreBounded) {
  const DrivableConfig config;
  expect_accepted(config, &DrivableConfig::cell, {0.05, 5.0});
  expect_refused(config, &DrivableConfig::cell, {0.04, 5.1, kNaN<double>}, "cell");
  expect_accepted(config, &DrivableConfig::robot_height, {config.step_height + 0.01, 10.0});
  expect_refused(config, &DrivableConfig::robot_height, {0.0, 10.1, kNaN<double>}, "robot_height");
  expect_accepted(config, &DrivableConfig::step_height, {0.0});
  expect_refused(config, &DrivableConfig::step_height, {-0.01, config.robot_height, kNaN<double>},
                 "step_height");
  expect_accepted(config, &DrivableConfig::max_slope_rad, {0.01, 1.5});
  expect_refused(config, &DrivableConfig::max_slope_rad, {0.0, 1.54, kNaN<double>}, "max_slope");
}

}  // namespace
}  // namespace fleetmap::sim
