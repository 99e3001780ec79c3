#include "site/site_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;
using testing::box;
using testing::kClearance;

constexpr double kCell = 0.25;

Mission with_boxes(const std::vector<KeepOut>& boxes) {
  Mission mission;
  mission.rows = {{0, {{-30, -30}, {30, 30}}}};
  mission.keep_out = boxes;
  return mission;
}

/// m, of p to a box; 0 inside.
double distance_to(const KeepOut& b, const Vector2d& p) {
  return (p - p.cwiseMax(b[0]).cwiseMin(b[2])).norm();
}

TEST(SiteGrid, ZonesAreThoseOfTheGeometry) {
  const std::vector<KeepOut> boxes = {box(-10, -10, -4, 5), box(0, 0, 8, 3),
                                      box(5, 1, 12, 9)};  // two overlap
  const SiteGrid grid(with_boxes(boxes), kClearance, kCell, 5.0, {});
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-15.0, 15.0);
  for (int k = 0; k < 2000; ++k) {
    const Vector2d p(anywhere(random), anywhere(random));
    double nearest = 1e9;
    for (const KeepOut& b : boxes) nearest = std::min(nearest, distance_to(b, p));
    if (nearest == 0.0) {
      EXPECT_NE(grid.zone(p) & SiteGrid::kInside, 0) << p.transpose();
    } else if (nearest < kClearance - kCell) {
      EXPECT_FALSE(grid.clear(p)) << p.transpose();
    } else if (nearest > kClearance + 2.0 * kCell) {
      EXPECT_TRUE(grid.clear(p)) << p.transpose();
    }
  }
  EXPECT_FALSE(grid.clear({1000.0, 0.0}));
}

TEST(SiteGrid, ALineIsClearIfNoCellUnderItIsNear) {
  const SiteGrid grid(with_boxes({box(0, 0, 2, 2)}), kClearance, kCell, 5.0, {});
  EXPECT_TRUE(grid.line_clear({-5, 5}, {10, 5}, SiteGrid::kNear));
  EXPECT_FALSE(grid.line_clear({-5, 1}, {10, 1}, SiteGrid::kNear));
  EXPECT_FALSE(grid.line_clear({-5, 2.4}, {10, 2.4}, SiteGrid::kNear));
  EXPECT_TRUE(grid.line_clear({-5, 2.4}, {10, 2.4}, SiteGrid::kInside));
}

TEST(SiteGrid, OutsideOfTheBoundaryIsInsideAKeepOut) {
  Mission mission = with_boxes({});
  mission.rows[0].waypoints = {{-5, 0}, {5, 0}};
  mission.boundary = box(-10, -10, 10, 10);
  const SiteGrid grid(mission, kClearance, kCell, 5.0, {});
  EXPECT_TRUE(grid.clear({0, 0}));
  EXPECT_FALSE(grid.clear({9.7, 0}));
  EXPECT_EQ(grid.zone({10.6, 0}) & SiteGrid::kInside, SiteGrid::kInside);
}

TEST(SiteGrid, TheNearestClearPointDoesNotLieBehindAKeepOut) {
  // p stands between two walls and a gap to the west.
  const SiteGrid grid(with_boxes({box(-3, 0.5, 3, 0.9), box(-3, -0.9, 3, -0.5)}), kClearance, kCell, 5.0, {});
  const Vector2d p(0, 0);
  ASSERT_FALSE(grid.clear(p));
  const auto free = grid.nearest_clear(p, 5.0);
  ASSERT_TRUE(free);
  EXPECT_TRUE(grid.clear(*free));
  EXPECT_GT(std::abs(free->x()), 3.0);
  EXPECT_LT(std::abs(free->y()), 0.6);
  EXPECT_FALSE(grid.nearest_clear(p, 1.0));
}

}  // namespace
}  // namespace fleetmap::planning
