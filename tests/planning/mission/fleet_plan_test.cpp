#include "fleetmap/planning/mission/fleet_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;

Mission small_site() {
  testing::SiteSpec spec;
  spec.width = spec.depth = 64.0;
  return testing::site(spec);
}

MissionConfig settings(bool rendezvous = true) {
  MissionConfig config;
  config.division.search_rounds = 5;
  config.rendezvous = rendezvous;
  return config;
}

FleetPlan plan_of(const std::vector<RobotAbility>& fleet, const MissionConfig& config = settings()) {
  const auto plan = plan_fleet(small_site(), fleet, config);
  EXPECT_TRUE(plan) << plan.error().message;
  return **plan;
}

bool passes(const Polyline& route, const Eigen::Vector2d& p) {
  return std::ranges::any_of(route, [&](const Eigen::Vector2d& q) { return (p - q).norm() < 1e-6; });
}

TEST(FleetPlan, RobotsAreInTheOrderOfTheirNames) {
  auto fleet = testing::fleet(3);
  std::rotate(fleet.begin(), fleet.begin() + 1, fleet.end());
  const FleetPlan plan = plan_of(fleet);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(plan.fleet[k].id, testing::name(static_cast<int>(k)));
    EXPECT_EQ(plan.division.routes[k].agent, plan.fleet[k].id);
    EXPECT_EQ(plan.find(plan.fleet[k].id), k);
  }
  EXPECT_EQ(plan.find(testing::name(7)), std::nullopt);
}

TEST(FleetPlan, ARouteLeadsFromTheStartThroughItsRowsToTheMeeting) {
  const FleetPlan plan = plan_of(testing::fleet(2));
  ASSERT_TRUE(plan.meeting);
  std::size_t rows = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const Polyline route = route_of(plan, k);
    EXPECT_EQ(route.front(), plan.fleet[k].start.position);
    EXPECT_LT((route.back() - plan.meeting->positions[k]).norm(), 1e-6);
    EXPECT_EQ(std::ranges::adjacent_find(route), route.end()) << "no point twice in a row";
    EXPECT_NEAR(length_of(route), plan.division.routes[k].length, 0.1);
    for (const RowVisit& visit : plan.division.routes[k].visits) {
      const Row& row = *std::ranges::find(plan.mission.rows, visit.row, &Row::id);
      EXPECT_TRUE(passes(route, row.waypoints.front())) << row.id;
      EXPECT_TRUE(passes(route, row.waypoints.back())) << row.id;
      ++rows;
    }
  }
  EXPECT_EQ(rows, plan.mission.rows.size());
}

TEST(FleetPlan, ItIsCompleteWhenTheLastOneArrivedAndAllIsExchanged) {
  const FleetPlan plan = plan_of(testing::fleet(2));
  ASSERT_TRUE(plan.meeting && plan.exchange);
  double last = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const RobotRoute& route = plan.division.routes[k];
    EXPECT_EQ(route.time, plan.meeting->arrivals[k]);
    EXPECT_NEAR(
        route.energy_wh,
        route.time * plan.fleet[k].power_idle_w / 3600.0 + route.length * plan.fleet[k].energy_per_metre_wh,
        1e-9);
    last = std::max(last, route.time);
  }
  EXPECT_EQ(plan.division.makespan, last);
  EXPECT_EQ(plan.meeting->latest, last);
  EXPECT_EQ(plan.completion, plan.exchange->completion);
  EXPECT_GE(plan.completion, last);
}

TEST(FleetPlan, WithoutARendezvousRoutesEndWithTheirLastRows) {
  const FleetPlan plan = plan_of(testing::fleet(2), settings(false));
  EXPECT_FALSE(plan.meeting);
  EXPECT_FALSE(plan.exchange);
  EXPECT_EQ(plan.completion, plan.division.makespan);
  for (std::size_t k = 0; k < 2; ++k) {
    const RowVisit& visit = plan.division.routes[k].visits.back();
    const Row& row = *std::ranges::find(plan.mission.rows, visit.row, &Row::id);
    EXPECT_LT(
        (route_of(plan, k).back() - (visit.reversed ? row.waypoints.front() : row.waypoints.back())).norm(),
        1e-6);
  }
}

/// s, when the last robot is where all meet best after these routes.
double latest_meeting(const FleetPlan& plan) {
  std::vector<Arrival> arrivals;
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) {
    const TimedPath path =
        timed_path(plan.planner, plan.mission, plan.fleet[k], plan.division.routes[k].visits, std::nullopt);
    arrivals.push_back({path.points.back(), path.times.back(), plan.fleet[k].speed});
  }
  return meeting_place(plan.planner, arrivals, plan.config.meeting)->latest;
}

TEST(FleetPlan, TheyMeetNoLaterThanAfterADivisionThatDoesNotKnowOfIt) {
  for (int robots = 2; robots <= 4; ++robots) {
    const auto fleet = testing::fleet(robots, true);
    EXPECT_LE(latest_meeting(plan_of(fleet)), latest_meeting(plan_of(fleet, settings(false))) + 1e-6)
        << robots;
  }
}

TEST(FleetPlan, WrongSettingsRobotsAndMissionsAreRefused) {
  const auto refusal = [](const Mission& mission, const std::vector<RobotAbility>& fleet,
                          const MissionConfig& config) {
    const auto plan = plan_fleet(mission, fleet, config);
    return plan ? "none" : plan.error().message;
  };
  const auto fleet = testing::fleet(2);
  EXPECT_EQ(refusal(small_site(), fleet, settings()), "none");
  MissionConfig config = settings();
  config.division.search_rounds = -1;
  EXPECT_THAT(refusal(small_site(), fleet, config), HasSubstr("search_rounds"));
  config = settings();
  config.meeting.c_max = 0.0;
  EXPECT_THAT(refusal(small_site(), fleet, config), HasSubstr("c_max"));
  auto standing = fleet;
  standing[1].speed = 0.0;
  EXPECT_THAT(refusal(small_site(), standing, settings()), HasSubstr("speed"));
  Mission twice = small_site();
  twice.rows[1].id = twice.rows[0].id;
  EXPECT_NE(refusal(twice, fleet, settings()), "none");
}

}  // namespace
}  // namespace fleetmap::planning
