#include "fleetmap/planning/routes/travel_costs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::planning {
namespace {

Mission two_rows() {
  Mission mission;
  mission.rows = {{3, {{0, 0}, {30, 0}}}, {4, {{0, 10}, {30, 10}, {30, 20}}}};
  return mission;
}

constexpr double kTolerance = 1e-4;  // travels are floats

TEST(TravelCosts, LengthsAndTurnsBetweenTheEndsOfRows) {
  const Mission mission = two_rows();
  const TravelCosts costs = *TravelCosts::create(*RoutePlanner::create(mission), mission);
  ASSERT_EQ(costs.rows(), 2u);
  EXPECT_NEAR(costs.along(0).length, 30.0, kTolerance);
  EXPECT_NEAR(costs.along(0).turn, 0.0, kTolerance);
  EXPECT_NEAR(costs.along(1).length, 40.0, kTolerance);
  EXPECT_NEAR(costs.along(1).turn, M_PI / 2, kTolerance);
  // From the first row's end up and into the second row's first waypoint: two turns of 90 deg and back.
  const Travel across = costs.between(0, 2);
  EXPECT_NEAR(across.length, 10.0, kTolerance);
  EXPECT_NEAR(across.turn, M_PI, kTolerance);
}

TEST(TravelCosts, TheWayBackIsAsLong) {
  const Mission mission = two_rows();
  const TravelCosts costs = *TravelCosts::create(*RoutePlanner::create(mission), mission);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      EXPECT_EQ(costs.between(a, b).length, costs.between(b, a).length);
      EXPECT_EQ(costs.between(a, b).turn, costs.between(b, a).turn);
    }
  }
}

TEST(TravelCosts, FromAPoseAndToAPlace) {
  const Mission mission = two_rows();
  const TravelCosts costs = *TravelCosts::create(*RoutePlanner::create(mission), mission);
  const auto from = costs.from({{-5, 0}, M_PI / 2});
  EXPECT_NEAR(from[0].length, 5.0, kTolerance);
  EXPECT_NEAR(from[0].turn, M_PI / 2, kTolerance);  // it looks north
  const auto to = costs.to({35, 0});
  EXPECT_NEAR(to[1].length, 5.0, kTolerance);
  EXPECT_NEAR(to[1].turn, 0.0, kTolerance);  // straight on
}

TEST(TravelCosts, TimeAndEnergyAreThoseOfTheRobot) {
  RobotAbility robot;
  robot.speed = 2.0;
  robot.yaw_rate = 0.5;
  robot.power_idle_w = 36.0;
  robot.energy_per_metre_wh = 0.1;
  const Travel travel{100.0f, 1.0f};
  EXPECT_NEAR(time_of(travel, robot), 52.0, 1e-6);
  EXPECT_NEAR(energy_of(travel, robot), 0.52 + 10.0, 1e-6);
}

TEST(TravelCosts, ARowBehindAWallIsNamed) {
  Mission mission = two_rows();
  mission.rows[1].waypoints = {{0, 40}, {30, 40}};
  mission.boundary = KeepOut{{-20, -20}, {50, -20}, {50, 60}, {-20, 60}};
  mission.keep_out = {{{-30, 20}, {60, 20}, {60, 22}, {-30, 22}}};
  const auto costs = TravelCosts::create(*RoutePlanner::create(mission), mission);
  ASSERT_FALSE(costs);
  EXPECT_THAT(costs.error().message, ::testing::HasSubstr("row 4 can't be reached from row 3"));
}

}  // namespace
}  // namespace fleetmap::planning
