#include "fleetmap/planning/driving/path_follower_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_not_negative;
using fleetmap::testing::expect_positive;
using fleetmap::testing::expect_refused;

TEST(PathFollowerConfig, DefaultsAreValid) { EXPECT_TRUE(PathFollowerConfig{}.validate()); }

TEST(PathFollowerConfig, WhatDividesIsPositive) {
  expect_positive(PathFollowerConfig{}, {{&PathFollowerConfig::max_speed, "max_speed"},
                                         {&PathFollowerConfig::max_reverse, "max_reverse"},
                                         {&PathFollowerConfig::max_yaw_rate, "max_yaw_rate"},
                                         {&PathFollowerConfig::acceleration, "acceleration"},
                                         {&PathFollowerConfig::braking, "braking"},
                                         {&PathFollowerConfig::robot_radius, "robot_radius"},
                                         {&PathFollowerConfig::wanted_clearance, "wanted_clearance"},
                                         {&PathFollowerConfig::horizon, "horizon"},
                                         {&PathFollowerConfig::corner_tolerance, "corner_tolerance"},
                                         {&PathFollowerConfig::goal_tolerance, "goal_tolerance"},
                                         {&PathFollowerConfig::give_up_radius, "give_up_radius"},
                                         {&PathFollowerConfig::give_up_after, "give_up_after"},
                                         {&PathFollowerConfig::turn_in_place, "turn_in_place"},
                                         {&PathFollowerConfig::stuck_after, "stuck_after"},
                                         {&PathFollowerConfig::stuck_distance, "stuck_distance"}});
  expect_not_negative(PathFollowerConfig{}, {{&PathFollowerConfig::reaction_time, "reaction_time"},
                                             {&PathFollowerConfig::margin, "margin"},
                                             {&PathFollowerConfig::lateral_error, "lateral_error"},
                                             {&PathFollowerConfig::lateral_weight, "lateral_weight"}});
}

TEST(PathFollowerConfig, HorizonAndClearanceAreBounded) {
  const PathFollowerConfig config;
  expect_accepted(config, &PathFollowerConfig::horizon, {2.0, 15.0});
  expect_refused(config, &PathFollowerConfig::horizon, {1.9, 15.1}, "horizon");
  expect_accepted(config, &PathFollowerConfig::wanted_clearance,
                  {config.robot_radius + config.margin + 0.01, 5.0});
  expect_refused(config, &PathFollowerConfig::wanted_clearance, {config.robot_radius + config.margin, 5.1},
                 "wanted_clearance");
}

}  // namespace
}  // namespace fleetmap::planning
