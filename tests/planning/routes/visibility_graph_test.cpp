#include "routes/visibility_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;
using testing::kClearance;

struct Site {
  explicit Site(std::vector<KeepOut> keep_out)
      : mission{{{0, {{-30, -30}, {30, 30}}}}, std::move(keep_out), {}, {}},
        grid(mission, kClearance, 0.25, 5.0, {}),
        graph(VisibilityGraph::of(mission, grid, kClearance)) {}
  Mission mission;
  SiteGrid grid;
  VisibilityGraph graph;
};

const KeepOut kBox = {{0, 0}, {10, 0}, {10, 4}, {0, 4}};

TEST(VisibilityGraph, PathsBendAtTheCornersOfABoxHeldOffByTheClearance) {
  for (const bool clockwise : {false, true}) {
    KeepOut box = kBox;
    if (clockwise) std::ranges::reverse(box);
    const Site site({box});
    ASSERT_EQ(site.graph.vertices.size(), 4u);
    for (const Vector2d& vertex : site.graph.vertices) {
      EXPECT_TRUE(site.grid.clear(vertex));
      const Vector2d outside = (vertex - vertex.cwiseMax(kBox[0]).cwiseMin(kBox[2]));
      EXPECT_GE(outside.cwiseAbs().minCoeff(), kClearance);
      EXPECT_LT(outside.norm(), 2.0 * kClearance);
    }
    // A ring: each corner sees its two neighbours, not the one across.
    for (const auto& edges : site.graph.edges) EXPECT_EQ(edges.size(), 2u);
    EXPECT_TRUE(std::isinf(site.graph.reach));
  }
}

TEST(VisibilityGraph, EdgesGoBothWaysAndAreClear) {
  const Site site({kBox, {{-8, -12}, {-2, -12}, {-5, -6}}, {{14, -3}, {20, -3}, {20, 12}, {14, 12}}});
  std::size_t edges = 0;
  for (std::uint32_t i = 0; i < site.graph.vertices.size(); ++i) {
    for (const auto& [j, length] : site.graph.edges[i]) {
      ++edges;
      const Vector2d &a = site.graph.vertices[i], &b = site.graph.vertices[j];
      EXPECT_DOUBLE_EQ(length, (b - a).norm());
      EXPECT_TRUE(site.grid.line_clear(a, b, SiteGrid::kNear));
      const auto& back = site.graph.edges[j];
      EXPECT_TRUE(std::ranges::any_of(back, [&](const auto& edge) { return edge.first == i; }));
    }
  }
  EXPECT_GT(edges, 20u);
}

TEST(VisibilityGraph, ConcaveCornersOfAKeepOutAreNoVertices) {
  const Site site({{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}});
  EXPECT_EQ(site.graph.vertices.size(), 5u);
}

}  // namespace
}  // namespace fleetmap::planning
