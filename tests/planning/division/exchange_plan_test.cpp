#include "fleetmap/planning/division/exchange_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

/// Open ground, one row after another along each robot's line.
struct Field {
  Mission mission;
  std::vector<RobotAbility> fleet;
  std::vector<RobotRoute> routes;
  Polyline meeting;

  /// Rows of `length` m to the east from `from`, each where the last one ended.
  void add(const Eigen::Vector2d& from, int rows, double length, const Eigen::Vector2d& end) {
    RobotAbility robot;
    robot.id = testing::name(static_cast<int>(fleet.size()));
    robot.start = {from, 0.0};
    RobotRoute route{robot.id, {}};
    for (int k = 0; k < rows; ++k) {
      const Eigen::Vector2d begin = from + Eigen::Vector2d(k * length, 0.0);
      const auto id = static_cast<RowId>(mission.rows.size());
      mission.rows.push_back({id, {begin, begin + Eigen::Vector2d(length, 0.0)}});
      route.visits.push_back({id, false});
    }
    fleet.push_back(robot);
    routes.push_back(route);
    meeting.push_back(end);
  }
  ExchangePlan plan(const RendezvousConfig& config, const ExchangeRules& rules = {true, 0.2}) const {
    const auto planner = RoutePlanner::create(mission);
    EXPECT_TRUE(planner);
    return plan_exchange(*planner, mission, fleet, routes, meeting, config, rules);
  }
};

TEST(ExchangePlan, RobotsSideBySideHaveNothingLeftForTheMeeting) {
  Field field;
  field.add({0, 0}, 2, 300.0, {600, 0});
  field.add({0, 50}, 2, 300.0, {600, 50});
  RendezvousConfig config;
  const ExchangePlan plan = field.plan(config);
  EXPECT_NEAR(plan.bytes_total, 2.0 * 600.0 * config.map_bytes_per_metre, 1.0);
  EXPECT_NEAR(plan.bytes_in_passing, plan.bytes_total, 0.02 * plan.bytes_total);
  EXPECT_NEAR(plan.completion, 400.0, 5.0);
  EXPECT_TRUE(plan.stops.empty());
}

TEST(ExchangePlan, RemainingMapsTakeTimeAtTheMeeting) {
  Field field;
  field.add({0, 0}, 2, 300.0, {600, 100});
  field.add({0, 200}, 2, 300.0, {600, 100});
  RendezvousConfig config;
  config.map_bytes_per_metre = 60e3;
  config.bandwidth = 2e6;
  const ExchangePlan plan = field.plan(config, {});
  const double rate = config.bandwidth * config.efficiency / 8.0;
  const double on_the_way = plan.bytes_in_passing;  // the last 45 m to the meeting
  EXPECT_GT(on_the_way, 0.0);
  EXPECT_LT(on_the_way, 0.1 * plan.bytes_total);
  EXPECT_NEAR(plan.transfer_at_meeting, (plan.bytes_total - on_the_way) / rate, 3.0);
  EXPECT_EQ(plan.completion, plan.completion_without_stops);
}

TEST(ExchangePlan, TwoWhoEndTogetherGainNothingByAStop) {
  // The exchange takes as long before the meeting as at it.
  Field field;
  field.add({0, 0}, 3, 300.0, {900, 100});
  field.add({0, 200}, 3, 300.0, {900, 100});
  RendezvousConfig config;
  config.map_bytes_per_metre = 60e3;
  config.bandwidth = 2e6;
  const ExchangePlan plan = field.plan(config);
  EXPECT_TRUE(plan.stops.empty());
  EXPECT_GT(plan.rejected, 0);
}

TEST(ExchangePlan, RobotWithTimeFetchesMapsFromTheLastOneAndPassesThemOn) {
  // The third robot drives far away and back. The others wait for it where all meet, out of its reach.
  Field field;
  field.add({0, 0}, 2, 300.0, {600, 150});
  field.add({0, 20}, 2, 300.0, {600, 154});
  field.add({0, 300}, 10, 200.0, {600, 158});
  RendezvousConfig config;
  config.map_bytes_per_metre = 60e3;
  config.bandwidth = 2e6;
  const ExchangePlan plan = field.plan(config);
  ASSERT_FALSE(plan.stops.empty());
  double saved = 0.0;
  for (const Detour& stop : plan.stops) {
    EXPECT_LE((stop.parts[0].place - stop.parts[1].place).norm(), config.c_max);
    EXPECT_GE(stop.saving, config.min_gain);
    EXPECT_GE(stop.leave,
              std::max(stop.parts[0].arrival, stop.parts[1].arrival) + config.stop_overhead - 0.1);
    for (const Detour::Part& part : stop.parts) {
      EXPECT_GE(part.after, 1u);
      EXPECT_LE(part.after, field.routes[part.robot].visits.size());
    }
    saved += stop.saving;
  }
  EXPECT_NEAR(plan.completion_without_stops - plan.completion, saved, 1e-6);
  EXPECT_GT(plan.bytes_at_stops, 0.0);
  // Batteries that the routes just use up allow none.
  for (std::size_t k = 0; k < field.fleet.size(); ++k) field.fleet[k].battery_wh = 1.0;
  EXPECT_TRUE(field.plan(config).stops.empty());
  EXPECT_TRUE(field.plan(config, {}).stops.empty());
}

TEST(ExchangePlan, AFleetsPlanTakesItsTimesFromIt) {
  testing::SiteSpec spec;
  spec.width = spec.depth = 120.0;
  MissionConfig config;
  config.division.search_rounds = 20;
  for (const DivisionMethod method : {DivisionMethod::kUniform, DivisionMethod::kEnergy}) {
    config.division.method = method;
    const auto plan = *plan_fleet(testing::site(spec), testing::fleet(3), config);
    ASSERT_TRUE(plan->exchange);
    EXPECT_EQ(plan->completion, plan->exchange->completion);
    EXPECT_GE(plan->completion, plan->division.makespan);
    for (std::size_t k = 0; k < 3; ++k) {
      const RobotRoute& route = plan->division.routes[k];
      const TimedPath path =
          timed_path(plan->planner, plan->mission, plan->fleet[k], route.visits, plan->meeting->positions[k]);
      EXPECT_NEAR(route.time, path.times.back(), 1e-6);
      EXPECT_NEAR(route.length, length_of(path.points), 1e-3);
    }
  }
}

TEST(ExchangePlan, SilentRadiosAndEmptyMapsEnd) {
  Field field;
  field.add({0, 0}, 2, 300.0, {600, 0});
  field.add({0, 300}, 2, 300.0, {600, 300});  // never in reach, at the meeting neither
  RendezvousConfig config;
  config.bandwidth = 1.0;
  EXPECT_TRUE(std::isfinite(field.plan(config).completion));
  config.map_bytes_per_metre = 0.0;
  EXPECT_NEAR(field.plan(config).completion, 400.0, 1.0);
}

}  // namespace
}  // namespace fleetmap::planning
