#include "global_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "graph/known_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::KnownFleet;

TEST(GlobalFit, AveragesIndependentErrors) {
  double squared = 0.0;
  constexpr int kRuns = 40;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    KnownFleet fleet(seed);
    fleet.add_agent("r1", 1.5);
    std::vector<Pose> T_odom_node;
    for (const Node& node : fleet.nodes) T_odom_node.push_back(node.T_odom_base);
    const Pose T = fit_to_global_poses(fleet.nodes, T_odom_node, fleet.site, 60.0);
    const Node& middle = fleet.nodes[15];
    squared += (T * middle.T_odom_base.translation() - fleet.truth(middle).translation()).squaredNorm();
  }
  // 30 fixes of 1.5 m an axis: about 1.5 / sqrt(30) an axis at the middle of the path.
  EXPECT_LT(std::sqrt(squared / kRuns / 3.0), 1.5 * 1.5 / std::sqrt(30.0));
}

}  // namespace
}  // namespace fleetmap::graph
