#include "fleetmap/graph/located_nodes.hpp"

#include <gtest/gtest.h>

#include "paper_placement.hpp"

namespace fleetmap::graph {
namespace {

const LocalFrame kSite(geo_point_from_degrees(49.0, 8.4, 110.0));

AgentId agent(const std::string& name) { return AgentId::parse(name).value(); }
Pose pose(double x, double y, double yaw) { return make_pose(rotation_from_rpy(0, 0, yaw), {x, y, 0.0}); }

/// Agents whose odometry frames lie at T_enu_odom, twenty nodes in a row each.
struct Fleet {
  std::vector<Node> nodes;
  std::vector<Alignment> alignments;
  std::map<NodeId, Pose> truth;

  void add(const std::string& name, const Pose& T_enu_odom, bool with_G) {
    for (std::uint32_t k = 0; k < 20; ++k) {
      Node node;
      node.id = {agent(name), k};
      node.stamp = stamp_from_ns(std::int64_t{k} * 4'000'000'000);
      node.T_odom_base = pose(5.0 * k, 0.0, 0.05 * k);
      const Pose T = T_enu_odom * node.T_odom_base;
      truth[node.id] = T;
      if (with_G) node.G = fix(T, node.stamp);
      nodes.push_back(node);
    }
  }
  static GlobalPose fix(const Pose& T, Stamp stamp) {
    GlobalPose G;
    G.stamp = stamp;
    G.position = kSite.to_geo(T.translation());
    G.q_enu_base =
        Eigen::Quaterniond(Eigen::Matrix3d(kSite.R_enu_local(G.position).transpose() * T.linear()));
    G.covariance = 0.01 * Matrix6d::Identity();
    return G;
  }
  void align(const std::string& i, std::uint32_t k, const std::string& j, std::uint32_t l,
             const Pose& error = Pose::Identity()) {
    Alignment a;
    a.i = {agent(i), k};
    a.j = {agent(j), l};
    a.computed_by = agent(i);
    a.seq = static_cast<std::uint32_t>(alignments.size());
    a.modes = {{truth.at(a.i).inverse() * truth.at(a.j) * error, 0.1, 0.9, 0.9, 1e-4 * Matrix6d::Identity()}};
    alignments.push_back(a);
  }
  std::vector<Node> located() const { return with_global_poses(nodes, alignments, kSite, 60.0); }
  double worst_error(const std::vector<Node>& located, const std::string& name) const {
    double worst = 0.0;
    for (const Node& node : located) {
      if (node.id.agent.str() != name) continue;
      const Pose error = truth.at(node.id).inverse() * pose_in(kSite, *node.G);
      worst = std::max({worst, error.translation().norm(), 10.0 * so3_log(error.linear()).norm()});
    }
    return worst;
  }
};

TEST(LocatedNodes, NodesThatHaveAllAGStayAsTheyAre) {
  Fleet fleet;
  fleet.add("a", pose(10, 20, 1.0), true);
  const auto located = fleet.located();
  ASSERT_EQ(located.size(), fleet.nodes.size());
  for (std::size_t k = 0; k < located.size(); ++k)
    EXPECT_EQ(located[k].G->covariance, fleet.nodes[k].G->covariance);
}

TEST(LocatedNodes, AnOutageIsBridgedByTheOdometryAndWeighsNothing) {
  Fleet fleet;
  fleet.add("a", pose(10, 20, 1.0), true);
  for (std::size_t k = 5; k < 12; ++k) fleet.nodes[k].G.reset();
  const auto located = fleet.located();
  EXPECT_LT(fleet.worst_error(located, "a"), 0.01);
  EXPECT_GT(located[7].G->covariance(0, 0), 1e5);
  EXPECT_LT(located[4].G->covariance(0, 0), 1.0);
}

TEST(LocatedNodes, AFrameWithoutAnyFixGoesWhereMostAlignmentsAgree) {
  Fleet fleet;
  fleet.add("a", pose(10, 20, 1.0), true);
  fleet.add("b", pose(-50, 0, 2.5), false);
  fleet.add("c", pose(70, -20, -1.5), false);
  fleet.align("a", 3, "b", 4, pose(0.0, 7.0, 0.0));  // one row off
  fleet.align("a", 8, "b", 9);
  fleet.align("a", 12, "b", 15);
  fleet.align("b", 2, "c", 2);  // c is tied to a by b alone
  std::vector<Node> located = fleet.located();
  EXPECT_LT(fleet.worst_error(located, "b"), 0.01);
  EXPECT_LT(fleet.worst_error(located, "c"), 0.01);
  std::ranges::reverse(fleet.nodes);
  std::ranges::reverse(fleet.alignments);
  const auto again = fleet.located();
  for (std::size_t k = 0; k < located.size(); ++k) EXPECT_EQ(again[k].G->position, located[k].G->position);
  // The same by the paper's placement.
  const Placement placement = place_by_min_rmse(located, fleet.alignments, kSite);
  ASSERT_EQ(placement.components.size(), 1u);
  EXPECT_TRUE(not_georeferenced(fleet.nodes, placement.components).empty());
}

TEST(LocatedNodes, WithoutAnyFixTheMapIsRightInItselfAndSaidToBeNowhere) {
  Fleet fleet;
  fleet.add("a", pose(10, 20, 1.0), false);
  fleet.add("b", pose(-50, 0, 2.5), false);
  fleet.add("d", pose(5, 5, 0.0), false);
  fleet.align("a", 8, "b", 9);
  const std::vector<Node> located = fleet.located();
  const Placement placement = place_by_min_rmse(located, fleet.alignments, kSite);
  const Pose T =
      placement.T_enu_node.at({agent("a"), 0}).inverse() * placement.T_enu_node.at({agent("b"), 0});
  const Pose truth = fleet.truth.at({agent("a"), 0}).inverse() * fleet.truth.at({agent("b"), 0});
  EXPECT_LT((truth.inverse() * T).translation().norm(), 0.02);
  EXPECT_LT(placement.T_enu_odom.at({agent("a"), 0}).translation().norm(), 0.1);
  EXPECT_EQ(not_georeferenced(fleet.nodes, placement.components).size(), 3u);
  // A fix of b alone georeferences a as well, and d stays nowhere.
  Fleet fixed = fleet;
  for (Node& node : fixed.nodes) {
    if (node.id.agent.str() == "b") node.G = Fleet::fix(fixed.truth.at(node.id), node.stamp);
  }
  EXPECT_LT(fixed.worst_error(fixed.located(), "a"), 0.02);
  EXPECT_EQ(not_georeferenced(fixed.nodes, placement.components),
            (std::vector<FrameId>{FrameId{agent("d"), 0}}));
}

TEST(LocatedNodes, ATiltedFrameIsTurnedLevel) {
  Fleet fleet;
  fleet.add("a", pose(0, 0, 0), false);
  const Eigen::Matrix3d tilt = rotation_from_rpy(0.3, -0.2, 0.0);
  for (Node& node : fleet.nodes) {
    node.T_odom_base = make_pose(tilt, Eigen::Vector3d::Zero()) * node.T_odom_base;
    node.up_in_base = node.T_odom_base.linear().transpose() * Eigen::Vector3d::UnitZ();
  }
  for (const Node& node : fleet.located()) {
    const Eigen::Vector3d up = pose_in(kSite, *node.G).linear() * node.up_in_base;
    EXPECT_NEAR(up.z(), 1.0, 1e-6);
  }
}

}  // namespace
}  // namespace fleetmap::graph
