#include "fleetmap/planning/division/division.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;

struct DividedSite {
  explicit DividedSite(const testing::SiteSpec& spec)
      : mission(testing::site(spec)),
        planner(*RoutePlanner::create(mission, {}, std::vector<Eigen::Vector2d>{{-12, -12}})),
        costs(*TravelCosts::create(planner, mission)) {}
  Division divide_by(DivisionMethod method, const std::vector<RobotAbility>& fleet) const {
    DivisionConfig config;
    config.method = method;
    config.search_rounds = 40;
    return *divide(mission, costs, fleet, std::nullopt, config);
  }
  Mission mission;
  RoutePlanner planner;
  TravelCosts costs;
};

testing::SiteSpec triangle() {
  testing::SiteSpec spec;
  spec.taper = 0.9;
  spec.depth = 120.0;
  return spec;
}

void expect_each_row_once(const DividedSite& site, const Division& division) {
  std::multiset<RowId> driven(division.left_out.begin(), division.left_out.end());
  for (const RobotRoute& route : division.routes) {
    for (const RowVisit& visit : route.visits) driven.insert(visit.row);
  }
  std::multiset<RowId> all;
  for (const Row& row : site.mission.rows) all.insert(row.id);
  EXPECT_EQ(driven, all);
}

TEST(Division, EveryRowIsDrivenOnceAndTimesAreThoseOfTheRoutes) {
  const DividedSite site(triangle());
  for (const DivisionMethod method :
       {DivisionMethod::kUniform, DivisionMethod::kBalanced, DivisionMethod::kEnergy}) {
    for (const bool mixed : {false, true}) {
      const auto fleet = testing::fleet(3, mixed);
      const Division division = site.divide_by(method, fleet);
      expect_each_row_once(site, division);
      double longest = 0.0;
      for (std::size_t k = 0; k < fleet.size(); ++k) {
        const RobotRoute& route = division.routes[k];
        const TimedPath path = timed_path(site.planner, site.mission, fleet[k], route.visits, std::nullopt);
        EXPECT_NEAR(route.time, path.times.back(), 0.02 * path.times.back() + 1.0);
        EXPECT_NEAR(route.length, length_of(path.points), 1.0);
        longest = std::max(longest, route.time);
      }
      EXPECT_EQ(division.makespan, longest);
    }
  }
}

TEST(Division, UniformIsContiguousAndEqual) {
  const DividedSite site(triangle());
  const Division division = site.divide_by(DivisionMethod::kUniform, testing::fleet(4));
  RowId next = 0;
  for (RobotRoute route : division.routes) {
    EXPECT_NEAR(static_cast<double>(route.visits.size()), static_cast<double>(site.mission.rows.size()) / 4.0,
                1.0);
    std::ranges::sort(route.visits, {}, &RowVisit::row);  // a share is driven in the best order
    for (const RowVisit& visit : route.visits) EXPECT_EQ(visit.row, next++);
  }
}

TEST(Division, UniformDrivesEachShareInTheBestOrder) {
  // Twelve lanes, each in five pieces; robots start at the south-west corner. Were each share driven from its
  // first row, those that begin in the east or in the middle of a lane would take as long as larger ones.
  testing::SiteSpec spec;
  spec.width = 200.0;
  spec.depth = 96.0;
  spec.missing = 0.0;
  spec.max_row_length = 42.0;
  const DividedSite site(spec);
  const auto rows = site.mission.rows.size();
  ASSERT_EQ(rows, 60u);
  double before = std::numeric_limits<double>::infinity();
  for (int robots = 2; robots <= 5; ++robots) {
    const Division division = site.divide_by(DivisionMethod::kUniform, testing::fleet(robots));
    for (const RobotRoute& route : division.routes)
      EXPECT_EQ(route.visits.size(), rows / static_cast<std::size_t>(robots));
    EXPECT_LT(division.makespan, before) << robots << " robots";
    before = division.makespan;
  }
}

TEST(Division, BalancedIsNeverSlowerThanUniformAndFasterOnOddSites) {
  const DividedSite site(triangle());
  for (int robots = 2; robots <= 5; ++robots) {
    for (const bool mixed : {false, true}) {
      const auto fleet = testing::fleet(robots, mixed);
      const double uniform = site.divide_by(DivisionMethod::kUniform, fleet).makespan;
      const double balanced = site.divide_by(DivisionMethod::kBalanced, fleet).makespan;
      EXPECT_LE(balanced, uniform);
      if (robots < 5 || mixed) {
        EXPECT_LT(balanced, 0.95 * uniform) << robots;
      }
    }
  }
}

TEST(Division, IsAsGoodAsTryingEverythingOnSmallSites) {
  testing::SiteSpec spec = triangle();
  spec.depth = 48.0;  // 6 rows
  const DividedSite site(spec);
  const auto fleet = testing::fleet(2, true);
  const Division division = site.divide_by(DivisionMethod::kBalanced, fleet);
  std::vector<std::vector<Travel>> from;
  for (const RobotAbility& robot : fleet) from.push_back(site.costs.from(robot.start));
  // All assignments, orders and directions.
  const auto fastest = [&](std::size_t robot, std::vector<std::size_t> rows) {
    double best = rows.empty() ? 0.0 : 1e9;
    std::ranges::sort(rows);
    do {
      for (std::size_t mask = 0; mask < (1u << rows.size()); ++mask) {
        double time = 0.0;
        for (std::size_t k = 0; k < rows.size(); ++k) {
          const std::size_t entry = 2 * rows[k] + (mask >> k & 1);
          const Travel way = k == 0 ? from[robot][entry]
                                    : site.costs.between(2 * rows[k - 1] + 1 - (mask >> (k - 1) & 1), entry);
          time += time_of(way, fleet[robot]) + time_of(site.costs.along(rows[k]), fleet[robot]);
        }
        if (!rows.empty()) best = std::min(best, time);
      }
    } while (std::ranges::next_permutation(rows).found);
    return best;
  };
  double optimum = 1e9;
  const std::size_t n = site.mission.rows.size();
  for (std::size_t mask = 0; mask < (1u << n); ++mask) {
    std::vector<std::size_t> rows[2];
    for (std::size_t k = 0; k < n; ++k) rows[mask >> k & 1].push_back(k);
    optimum = std::min(optimum, std::max(fastest(0, rows[0]), fastest(1, rows[1])));
  }
  EXPECT_LE(division.makespan, 1.01 * optimum);
  EXPECT_GE(division.makespan, optimum - 1e-3);
}

TEST(Division, EnergyKeepsTheReserveAndLeavesOutWhatNoBatteryReaches) {
  const DividedSite site(triangle());
  auto fleet = testing::fleet(3);
  fleet[0].battery_wh = 12.0;
  const Division some = site.divide_by(DivisionMethod::kEnergy, fleet);
  EXPECT_TRUE(some.left_out.empty());
  EXPECT_GT(site.divide_by(DivisionMethod::kBalanced, fleet).routes[0].energy_wh, 0.8 * 12.0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(some.routes[k].energy_wh, 0.8 * fleet[k].battery_wh);
  for (RobotAbility& robot : fleet) robot.battery_wh = 12.0;
  const Division few = site.divide_by(DivisionMethod::kEnergy, fleet);
  EXPECT_FALSE(few.left_out.empty());
  expect_each_row_once(site, few);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(few.routes[k].energy_wh, 0.8 * fleet[k].battery_wh);
}

TEST(Division, TheSameInputGivesTheSameAnswerInAnyOrderOfRobots) {
  const Mission mission = testing::site(triangle());
  auto fleet = testing::fleet(3, true);
  const auto first = *plan_fleet(mission, fleet, {});
  std::ranges::reverse(fleet);
  const auto second = *plan_fleet(mission, fleet, {});
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(first->division.routes[k].agent, second->division.routes[k].agent);
    EXPECT_EQ(first->division.routes[k].visits, second->division.routes[k].visits);
  }
  EXPECT_EQ(first->meeting->place, second->meeting->place);
}

TEST(Division, ImpossibleFleetsAreRefusedWithARemedy) {
  testing::SiteSpec spec;
  spec.depth = 16.0;  // two rows
  const auto more = plan_fleet(testing::site(spec), testing::fleet(3), {});
  ASSERT_FALSE(more);
  EXPECT_THAT(more.error().message, AllOf(HasSubstr("3 robots for 2 rows"), HasSubstr("max_row_length")));
  auto twins = testing::fleet(2);
  twins[1].id = twins[0].id;
  EXPECT_FALSE(plan_fleet(testing::site(spec), twins, {}));
  auto inside = testing::fleet(2);
  inside[1].start.position = {100.0, 0.0};  // among the tables, but too near to tell: joined to the lane
  EXPECT_TRUE(plan_fleet(testing::site(spec), inside, {}));
  Mission walled = testing::site(spec);
  walled.keep_out.push_back({{-30, -40}, {-10, -40}, {-10, 60}, {-30, 60}});
  inside[1].start.position = {-20.0, 0.0};
  const auto stuck = plan_fleet(walled, inside, {});
  ASSERT_FALSE(stuck);
  EXPECT_THAT(stuck.error().message, HasSubstr("robot r2"));
  EXPECT_FALSE(plan_fleet(testing::site(spec), {}, {}));
  EXPECT_FALSE(plan_fleet({}, testing::fleet(2), {}));
}

TEST(Division, ARowThatIsCutOffIsNamed) {
  Mission mission;
  mission.rows = {{4, {{0, 0}, {50, 0}}}, {9, {{20, 20}, {30, 20}}}};
  mission.keep_out = {{{10, 10}, {40, 10}, {40, 11}, {10, 11}},
                      {{10, 30}, {40, 30}, {40, 31}, {10, 31}},
                      {{10, 10}, {11, 10}, {11, 31}, {10, 31}},
                      {{39, 10}, {40, 10}, {40, 31}, {39, 31}}};
  const auto plan = plan_fleet(mission, testing::fleet(2), {});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("row 9 can't be reached from row 4"));
}

}  // namespace
}  // namespace fleetmap::planning
