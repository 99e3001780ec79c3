#include "division/timed_route.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::Rows;

struct RaggedSite {
  RaggedSite() {
    testing::SiteSpec spec;
    spec.width = spec.depth = 80.0;
    spec.ragged = 0.2;
    mission = testing::site(spec);
    planner.emplace(*RoutePlanner::create(mission, {}, std::vector<Eigen::Vector2d>{{-10, -10}}));
    costs.emplace(*TravelCosts::create(*planner, mission));
    worker = {testing::fleet(1)[0], costs->from({{-8, -8}, 0.3}), 7.0};
    to_end = costs->to({-8, 40});
  }
  /// s, the least over all directions of the rows.
  double brute_force(const Rows& rows) const {
    if (rows.empty()) return worker.busy;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t directions = 0; directions < (1u << rows.size()); ++directions) {
      const auto reversed = [&](std::size_t k) { return directions >> k & 1; };
      Travel all = worker.from[2 * rows[0] + reversed(0)];
      for (std::size_t k = 0; k < rows.size(); ++k) {
        const std::size_t out = 2 * rows[k] + 1 - reversed(k);
        all = all + costs->along(rows[k]);
        all = all +
              (k + 1 < rows.size() ? costs->between(out, 2 * rows[k + 1] + reversed(k + 1)) : to_end[out]);
      }
      best = std::min(best, worker.busy + time_of(all, worker.ability));
    }
    return best;
  }

  Mission mission;
  std::optional<RoutePlanner> planner;
  std::optional<TravelCosts> costs;
  Worker worker;
  std::vector<Travel> to_end;
};

constexpr double kRounding = 1e-3;  // s: travels are floats

TEST(TimedRoute, TimesOfAllChangesAreThoseOfBruteForce) {
  const RaggedSite site;
  ASSERT_GE(site.mission.rows.size(), 8u);
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    Rows all(site.mission.rows.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
    std::ranges::shuffle(all, random);
    const Rows rows(all.begin(), all.begin() + 4);
    const Rows others(all.begin() + 5, all.begin() + 8);
    const std::size_t more = all[4];
    TimedRoute route(*site.costs, site.to_end, site.worker);
    TimedRoute other(*site.costs, site.to_end, site.worker);
    route.assign(rows);
    other.assign(others);
    EXPECT_NEAR(route.time(), site.brute_force(rows), kRounding);
    EXPECT_NEAR(route.time_of_order(others), site.brute_force(others), kRounding);
    for (std::size_t k = 0; k <= rows.size(); ++k) {
      Rows with = rows;
      with.insert(with.begin() + static_cast<std::ptrdiff_t>(k), more);
      EXPECT_NEAR(route.time_with(k, more), site.brute_force(with), kRounding);
      for (std::size_t from = 0; from <= others.size(); ++from) {
        Rows joined(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(k));
        joined.insert(joined.end(), others.begin() + static_cast<std::ptrdiff_t>(from), others.end());
        EXPECT_NEAR(route.time_joined(k, other, from), site.brute_force(joined), kRounding);
      }
      if (k == rows.size()) break;
      Rows without = rows, replaced = rows;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
      replaced[k] = more;
      EXPECT_NEAR(route.time_without(k), site.brute_force(without), kRounding);
      EXPECT_NEAR(route.time_replaced(k, more), site.brute_force(replaced), kRounding);
    }
  }
}

TEST(TimedRoute, DirectionsAndTravelAreThoseOfTheTime) {
  const RaggedSite site;
  TimedRoute route(*site.costs, site.to_end, site.worker);
  route.assign({0, 1, 2, 3});
  EXPECT_EQ(route.directions().size(), 4u);
  EXPECT_NEAR(site.worker.busy + time_of(route.travel(), site.worker.ability), route.time(), kRounding);
}

TEST(TimedRoute, OvertimeIsWhatTheBatteryLacks) {
  RaggedSite site;
  TimedRoute free(*site.costs, site.to_end, site.worker);
  free.assign({0, 1});
  EXPECT_EQ(free.overtime(), 0.0);
  site.worker.energy_wh = 0.5;
  TimedRoute tight(*site.costs, site.to_end, site.worker);
  tight.assign({0, 1});
  EXPECT_GT(tight.overtime(), 0.0);
  EXPECT_LT(tight.overtime(), tight.time());
}

}  // namespace
}  // namespace fleetmap::planning
