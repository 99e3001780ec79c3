#include "paper_placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "graph/known_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::KnownFleet;

double distance(const Pose& a, const Pose& b) { return se3_log(a.inverse() * b).norm(); }

TEST(PaperPlacement, ExactGlobalPosesPlaceEveryNodeExactly) {
  KnownFleet fleet(1);
  fleet.add_agent("r1", 0.0);
  fleet.add_agent("r2", 0.0);
  const Placement placement = place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site);
  ASSERT_EQ(placement.T_enu_node.size(), fleet.nodes.size());
  for (const Node& node : fleet.nodes)
    EXPECT_LT(distance(placement.T_enu_node.at(node.id), fleet.truth(node)), 1e-6);
  EXPECT_EQ(placement.components.size(), 2u);
}

TEST(PaperPlacement, AlignmentFixesTheRelativePoseWhateverTheGpsError) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    KnownFleet fleet(seed);
    fleet.add_agent("r1", 3.0);
    fleet.add_agent("r2", 3.0);
    fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.1);
    const Placement placement = place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site);
    const Node& a = fleet.node("r1", 20);
    const Node& b = fleet.node("r2", 25);
    const Pose placed = placement.T_enu_node.at(a.id).inverse() * placement.T_enu_node.at(b.id);
    EXPECT_LT(distance(placed, fleet.truth(a).inverse() * fleet.truth(b)), 1e-6) << "seed " << seed;
    EXPECT_EQ(placement.components.size(), 1u);
  }
}

TEST(PaperPlacement, LeastRmseOfAPairIsKeptAndBadOnesDoNotCount) {
  KnownFleet fleet(3);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  Pose slip = Pose::Identity();
  slip.translation().x() = 5.0;
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.3, slip);
  fleet.align(fleet.node("r1", 6), fleet.node("r2", 8), 0.1);
  fleet.align(fleet.node("r2", 9), fleet.node("r1", 8), 0.2, slip);
  const Placement placement = place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site);
  ASSERT_EQ(placement.used.size(), 1u);
  EXPECT_EQ(placement.used.front().seq, 1u);

  for (Alignment& a : fleet.alignments) a.modes.front().rmse = 0.5;
  EXPECT_TRUE(place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site).used.empty());
}

TEST(PaperPlacement, AmbiguousAlignmentsDoNotCount) {
  KnownFleet fleet(7);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.1);
  fleet.alignments.front().modes.push_back(fleet.alignments.front().best());
  EXPECT_TRUE(place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site).used.empty());
}

TEST(PaperPlacement, SameSetSamePlacementWhateverTheOrder) {
  KnownFleet fleet(4);
  for (const char* name : {"r1", "r2", "r3", "r4"}) fleet.add_agent(name, 1.5);
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.30);
  fleet.align(fleet.node("r3", 5), fleet.node("r2", 9), 0.20);
  fleet.align(fleet.node("r3", 6), fleet.node("r1", 9), 0.25);
  const Placement reference = place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site);
  EXPECT_EQ(reference.components.size(), 2u) << "r4 has no alignment";
  EXPECT_EQ(reference.used.size(), 2u) << "the third alignment would close a loop";
  for (int shuffle = 0; shuffle < 10; ++shuffle) {
    std::ranges::shuffle(fleet.nodes, fleet.random);
    std::ranges::shuffle(fleet.alignments, fleet.random);
    const Placement placement = place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site);
    for (const auto& [id, T] : reference.T_enu_node) {
      EXPECT_TRUE(T.matrix() == placement.T_enu_node.at(id).matrix()) << to_string(id);
    }
  }
}

TEST(PaperPlacement, RestartedAgentIsAFrameOfItsOwnUntilAlignedWithItself) {
  KnownFleet fleet(6);
  fleet.add_agent("r1", 2.0);
  const Pose T_before_after = make_pose(rotation_from_rpy(0.0, 0.0, 1.0), Eigen::Vector3d(4.0, -7.0, 0.5));
  for (Node& node : fleet.nodes) {
    if (node.id.seq < 15) continue;
    node.session = 1;
    node.T_odom_base = T_before_after.inverse() * node.T_odom_base;
  }
  EXPECT_EQ(place_by_min_rmse(fleet.nodes, {}, fleet.site).components.size(), 2u);

  const Node before = fleet.node("r1", 10);
  const Node after = fleet.node("r1", 20);
  Alignment alignment{.i = before.id, .j = after.id, .computed_by = before.id.agent};
  alignment.modes.front().T_i_j = before.T_odom_base.inverse() * T_before_after * after.T_odom_base;
  alignment.modes.front().rmse = 0.1;
  const Placement placement = place_by_min_rmse(fleet.nodes, std::vector{alignment}, fleet.site);
  EXPECT_EQ(placement.components.size(), 1u);
  const Pose placed = placement.T_enu_node.at(fleet.node("r1", 0).id).inverse() *
                      placement.T_enu_node.at(fleet.node("r1", 29).id);
  const Pose truth =
      fleet.node("r1", 0).T_odom_base.inverse() * T_before_after * fleet.node("r1", 29).T_odom_base;
  EXPECT_LT(distance(placed, truth), 1e-6);
}

TEST(PaperPlacement, AlignmentOfAnUnknownNodeWaits) {
  KnownFleet fleet(5);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 29), 0.1);
  fleet.nodes.pop_back();
  EXPECT_TRUE(place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site).used.empty());
}

TEST(PaperPlacement, NothingInNothingOut) {
  const Placement placement = place_by_min_rmse({}, {}, LocalFrame(testing::kKnownOrigin));
  EXPECT_TRUE(placement.T_enu_node.empty());
  EXPECT_TRUE(placement.components.empty());
}

}  // namespace
}  // namespace fleetmap::graph
