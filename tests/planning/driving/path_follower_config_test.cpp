#include "fleetmap/planning/driving/path_follower_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_not_negative;
using fleetmap::testing::expect_positive;
using fleetmap::testing::expect_refused;

using Config = PathFollowerConfig;

TEST(PathFollowerConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(PathFollowerConfig, WhatDividesIsPositive) {
  expect_positive(Config{}, {{&Config::max_speed, "max_speed"},
                             {&Config::max_reverse, "max_reverse"},
                             {&Config::max_yaw_rate, "max_yaw_rate"},
                             {&Config::acceleration, "acceleration"},
                             {&Config::braking, "braking"},
                             {&Config::robot_radius, "robot_radius"},
                             {&Config::wanted_clearance, "wanted_clearance"},
                             {&Config::horizon, "horizon"},
                             {&Config::corner_tolerance, "corner_tolerance"},
                             {&Config::goal_tolerance, "goal_tolerance"},
                             {&Config::give_up_radius, "give_up_radius"},
                             {&Config::give_up_after, "give_up_after"},
                             {&Config::turn_in_place, "turn_in_place"},
                             {&Config::stuck_after, "stuck_after"},
                             {&Config::stuck_distance, "stuck_distance"}});
  expect_not_negative(Config{}, {{&Config::reaction_time, "reaction_time"},
                                 {&Config::margin, "margin"},
                                 {&Config::lateral_error, "lateral_error"},
                                 {&Config::lateral_weight, "lateral_weight"}});
}

TEST(PathFollowerConfig, HorizonAndClearanceAreBounded) {
  const Config config;
  expect_accepted(config, &Config::horizon, {2.0, 15.0});
  expect_refused(config, &Config::horizon, {1.9, 15.1}, "horizon");
  expect_accepted(config, &Config::wanted_clearance, {config.robot_radius + config.margin + 0.01, 5.0});
  expect_refused(config, &Config::wanted_clearance, {config.robot_radius + config.margin, 5.1},
                 "wanted_clearance");
}

}  // namespace
}  // namespace fleetmap::planning
