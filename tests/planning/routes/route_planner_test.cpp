#include "fleetmap/planning/routes/route_planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;
using testing::box;
using ::testing::HasSubstr;

Mission with(std::vector<KeepOut> keep_out, double reach = 60.0) {
  Mission mission;
  mission.rows.push_back({0, {{-reach, -reach}, {reach, reach}}});
  mission.keep_out = std::move(keep_out);
  return mission;
}

double distance_to_outline(const KeepOut& polygon, const Vector2d& p) {
  double best = 1e9;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d a = polygon[k];
    const Vector2d d = polygon[(k + 1) % polygon.size()] - a;
    const double on = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
    best = std::min(best, (a + on * d - p).norm());
  }
  return best;
}

TEST(RoutePlanner, OnOpenGroundTheWayIsStraight) {
  const auto planner = *RoutePlanner::create(with({}));
  const auto line = *planner.route({0, 0}, {30, 40});
  EXPECT_EQ(line.size(), 2u);
  EXPECT_NEAR(length_of(line), 50.0, 1e-9);
}

TEST(RoutePlanner, GoesAroundACornerAtTheClearance) {
  const KeepOut wall = box(-1, -20, 1, 20);
  const auto planner = *RoutePlanner::create(with({wall}));
  const auto line = *planner.route({-10, 0}, {10, 0});
  const double shortest = 2.0 * std::hypot(9.0 - 0.7, 20.7) + 2.0 + 1.4;  // around the far ends
  EXPECT_NEAR(length_of(line), shortest, 1.0);
  for (std::size_t k = 1; k < line.size(); ++k) {
    for (double t = 0.0; t <= 1.0; t += 0.01) {
      EXPECT_GT(distance_to_outline(wall, line[k - 1] + t * (line[k] - line[k - 1])), 0.7 - 0.2);
    }
  }
}

/// Length by Dijkstra on a fine lattice with 16 neighbours: never shorter than the truth by more than cells.
double lattice_length(const RoutePlanner& planner, const Vector2d& from, const Vector2d& to) {
  const double cell = 0.5;
  const int n = 240;
  const auto at = [&](int k) { return Vector2d(-60.0 + cell * (k % n), -60.0 + cell * (k / n)); };
  const auto index = [&](const Vector2d& p) {
    return static_cast<int>(std::lround((p.y() + 60.0) / cell)) * n +
           static_cast<int>(std::lround((p.x() + 60.0) / cell));
  };
  std::vector<double> best(static_cast<std::size_t>(n * n), 1e9);
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
  open.emplace(0.0, index(from));
  best[static_cast<std::size_t>(index(from))] = 0.0;
  while (!open.empty()) {
    const auto [d, k] = open.top();
    open.pop();
    if (d > best[static_cast<std::size_t>(k)]) continue;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int x = k % n + dx;
        const int y = k / n + dy;
        if (x < 0 || y < 0 || x >= n || y >= n || (dx == 0 && dy == 0)) continue;
        const int next = y * n + x;
        const double through = d + cell * std::hypot(dx, dy);
        if (through >= best[static_cast<std::size_t>(next)] || !planner.clear(at(k), at(next))) continue;
        best[static_cast<std::size_t>(next)] = through;
        open.emplace(through, next);
      }
    }
  }
  return best[static_cast<std::size_t>(index(to))];
}

TEST(RoutePlanner, IsAsShortAsALatticeSearchAmongRandomObstacles) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<KeepOut> obstacles;
    for (int k = 0; k < 25; ++k) {
      const Vector2d c(90.0 * testing::uniform(random) - 45.0, 90.0 * testing::uniform(random) - 45.0);
      const double turn = 6.28 * testing::uniform(random);
      const double radius = 3.0 + 7.0 * testing::uniform(random);
      KeepOut polygon;
      const int corners = 3 + static_cast<int>(random() % 4);
      for (int j = 0; j < corners; ++j) {
        const double angle = turn + (seed % 2 ? 1.0 : -1.0) * 6.2832 * j / corners;
        polygon.push_back(c + radius * Vector2d(std::cos(angle), std::sin(angle)));
      }
      obstacles.push_back(polygon);
    }
    const auto planner = *RoutePlanner::create(with(obstacles));
    for (const auto& [from, to] :
         {std::pair{Vector2d(-55, -55), Vector2d(55, 55)}, {Vector2d(-55, 50), Vector2d(55, -50)}}) {
      const auto line = planner.route(from, to);
      ASSERT_TRUE(line) << line.error().message;
      for (std::size_t k = 1; k < line->size(); ++k) EXPECT_TRUE(planner.clear((*line)[k - 1], (*line)[k]));
      const double lattice = lattice_length(planner, from, to);
      EXPECT_LT(length_of(*line), lattice * 1.005) << seed;
      EXPECT_GT(length_of(*line), lattice * 0.96) << seed;
    }
  }
}

TEST(RoutePlanner, SaysWhyThereIsNoWay) {
  // A pen of four thin walls around the goal.
  const auto planner =
      *RoutePlanner::create(with({box(10, 10, 30, 10.1), box(10, 30, 30, 30.1), box(10, 10, 10.1, 30),
                                  box(30, 10, 30.1, 30), box(-30, -30, -10, -10)}));
  const auto closed = planner.route({0, 0}, {20, 20});
  ASSERT_FALSE(closed);
  EXPECT_THAT(closed.error().message, HasSubstr("gate"));
  const auto inside = planner.route({0, 0}, {-20, -20});
  ASSERT_FALSE(inside);
  EXPECT_THAT(inside.error().message, HasSubstr("stands in a keep-out"));
  EXPECT_FALSE(planner.route({std::nan(""), 0}, {1, 1}));
  EXPECT_FALSE(planner.route({0, 0}, {500, 0}));
}

TEST(RoutePlanner, ARowIsDrivenAsGivenButAroundKeepOuts) {
  const auto planner = *RoutePlanner::create(with({box(20, -2, 24, 2), box(-40, 0.5, -20, 3)}));
  const Row through{1, {{0, 0}, {40, 0}}};
  const auto around = *planner.along(through, true);
  EXPECT_EQ(around.front(), Vector2d(40, 0));
  EXPECT_EQ(around.back(), Vector2d(0, 0));
  EXPECT_GT(length_of(around), 40.2);
  const Row narrow{2, {{-40, 0}, {-20, 0}}};  // half a metre beside a table, as the mission wants it
  EXPECT_NEAR(length_of(*planner.along(narrow, false)), 20.0, 1e-9);
}

TEST(RoutePlanner, AvoidsWhatTurnedOutToBeBlocked) {
  const auto planner =
      *RoutePlanner::create(with({box(-50, 2, -1, 4), box(1, 2, 50, 4), box(-50, -6, 20, -4)}));
  const Vector2d from(0, 10), to(0, 0);
  EXPECT_NEAR(length_of(*planner.route(from, to)), 10.0, 1e-9);
  const Blockage gate{{0, 3}, 1.4};
  EXPECT_GT(length_of(*planner.route(from, to, {&gate, 1})), 100.0);
}

TEST(RoutePlanner, HugeSitesAreJoinedOverTheLattice) {
  std::vector<KeepOut> trees;
  std::mt19937_64 random(3);
  for (int k = 0; k < 1000; ++k) {
    const double x = 1000.0 * testing::uniform(random) - 500.0;
    const double y = 1000.0 * testing::uniform(random) - 500.0;
    trees.push_back(box(x, y, x + 1.0, y + 1.0));
  }
  const auto planner = *RoutePlanner::create(with(trees, 510.0));
  const auto line = planner.route({-505, -505}, {505, 505});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_LT(length_of(*line), 1.03 * 1010.0 * std::sqrt(2.0));
  for (std::size_t k = 1; k < line->size(); ++k) EXPECT_TRUE(planner.clear((*line)[k - 1], (*line)[k]));
}

}  // namespace
}  // namespace fleetmap::planning
