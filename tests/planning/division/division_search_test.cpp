#include "division/division_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::Rows;

/// Lanes that grow longer from south to north, and robots at their south-west corner.
struct TaperedSite {
  explicit TaperedSite(double depth = 96.0) {
    testing::SiteSpec spec;
    spec.width = 120.0;
    spec.depth = depth;
    spec.taper = 0.8;
    mission = testing::site(spec);
    planner.emplace(*RoutePlanner::create(mission, {}, std::vector<Eigen::Vector2d>{{-12, -12}}));
    costs.emplace(*TravelCosts::create(*planner, mission));
    rows.resize(mission.rows.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
  }
  std::vector<Worker> workers(int count, bool mixed = false) const {
    std::vector<Worker> all;
    for (const RobotAbility& robot : testing::fleet(count, mixed))
      all.push_back({robot, costs->from(robot.start), 0.0});
    return all;
  }
  std::vector<TimedRoute> search(const std::vector<Worker>& workers, std::uint64_t seed = 1) const {
    DivisionConfig config;
    config.search_rounds = 20;
    config.seed = seed;
    return search_division(*costs, rows, workers, to_end, config);
  }

  Mission mission;
  std::optional<RoutePlanner> planner;
  std::optional<TravelCosts> costs;
  Rows rows;
  std::vector<Travel> to_end;
};

double makespan(const std::vector<TimedRoute>& routes) {
  double last = 0.0;
  for (const TimedRoute& route : routes) last = std::max(last, route.time());
  return last;
}

std::multiset<std::size_t> driven(const std::vector<TimedRoute>& routes) {
  std::multiset<std::size_t> rows;
  for (const TimedRoute& route : routes) rows.insert(route.rows().begin(), route.rows().end());
  return rows;
}

std::vector<Rows> orders(const std::vector<TimedRoute>& routes) {
  std::vector<Rows> all;
  for (const TimedRoute& route : routes) all.push_back(route.rows());
  return all;
}

TEST(DivisionSearch, UniformSharesAreNeighboursInTheOrderOfTheWorkers) {
  const TaperedSite site;
  for (int count = 1; count <= 5; ++count) {
    const auto workers = site.workers(count);
    const auto routes = uniform_division(*site.costs, site.rows, workers, site.to_end);
    ASSERT_EQ(routes.size(), workers.size());
    std::size_t next = 0;
    for (const TimedRoute& route : routes) {
      Rows share = route.rows();
      EXPECT_NEAR(static_cast<double>(share.size()), static_cast<double>(site.rows.size()) / count, 1.0);
      std::ranges::sort(share);
      for (const std::size_t row : share) EXPECT_EQ(row, next++);
      EXPECT_LE(route.time(), route.time_of_order(share) + 1e-3) << "the best order was looked for";
    }
    EXPECT_EQ(next, site.rows.size());
  }
}

TEST(DivisionSearch, EveryRowIsDrivenOnceAndNoLaterThanWithEqualShares) {
  const TaperedSite site;
  for (int count = 1; count <= 5; ++count) {
    for (const bool mixed : {false, true}) {
      const auto workers = site.workers(count, mixed);
      const auto routes = site.search(workers);
      EXPECT_EQ(driven(routes), std::multiset<std::size_t>(site.rows.begin(), site.rows.end()));
      EXPECT_LE(makespan(routes),
                makespan(uniform_division(*site.costs, site.rows, workers, site.to_end)) + 1e-6);
    }
  }
}

TEST(DivisionSearch, OneWorkersOrderIsTheBestOfAll) {
  const TaperedSite site(56.0);
  ASSERT_EQ(site.rows.size(), 7u);
  const auto workers = site.workers(1);
  const auto routes = site.search(workers);
  Rows order = site.rows;
  double best = routes[0].time();
  do {
    best = std::min(best, routes[0].time_of_order(order));
  } while (std::ranges::next_permutation(order).found);
  EXPECT_LE(routes[0].time(), 1.001 * best);
}

TEST(DivisionSearch, TheSameSeedGivesTheSameAnswer) {
  const TaperedSite site;
  const auto workers = site.workers(3, true);
  EXPECT_EQ(orders(site.search(workers)), orders(site.search(workers)));
}

TEST(DivisionSearch, BusyRobotsAndEmptyBatteriesGetNoRows) {
  const TaperedSite site;
  auto workers = site.workers(3);
  workers[1].busy = 1e5;
  auto routes = site.search(workers);
  EXPECT_TRUE(routes[1].rows().empty());
  EXPECT_EQ(driven(routes).size(), site.rows.size());
  workers = site.workers(3);
  workers[0].energy_wh = 0.01;
  routes = site.search(workers);
  EXPECT_TRUE(routes[0].rows().empty());
  EXPECT_EQ(driven(routes).size(), site.rows.size());
}

TEST(DivisionSearch, TheWayToTheEndCounts) {
  TaperedSite site(56.0);
  const auto workers = site.workers(1);
  const TimedRoute home = site.search(workers)[0];
  // Far in the north-west: the last row is one from where it is near.
  site.to_end = site.costs->to({0, 55});
  const TimedRoute north = site.search(workers)[0];
  EXPECT_GT(north.rows().back(), north.rows().front());
  EXPECT_GT(north.time(), home.time());
  TimedRoute reversed = north;
  Rows order = north.rows();
  std::ranges::reverse(order);
  reversed.assign(order);
  EXPECT_LT(north.time(), reversed.time());
}

TEST(DivisionSearch, NoRowsAreDividedIntoNothing) {
  TaperedSite site;
  site.rows.clear();
  auto workers = site.workers(2);
  workers[1].busy = 7.0;
  const auto routes = site.search(workers);
  ASSERT_EQ(routes.size(), 2u);
  EXPECT_TRUE(driven(routes).empty());
  EXPECT_EQ(routes[0].time(), 0.0);
  EXPECT_EQ(routes[1].time(), 7.0);
  site.rows = {4};
  EXPECT_EQ(driven(site.search(site.workers(2))), (std::multiset<std::size_t>{4}));
}

}  // namespace
}  // namespace fleetmap::planning
