#include "fleetmap/graph/placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace fleetmap::graph {
namespace {

const GeoPoint kOrigin = geo_point_from_degrees(48.98, 8.39, 110.0);

/// A fleet whose truth is known: each agent's odometry frame lies somewhere in ENU, each node's G has a small
/// error.
struct Fleet {
  LocalFrame site{kOrigin};
  std::map<AgentId, Pose> T_enu_odom;
  std::vector<Node> nodes;
  std::vector<Alignment> alignments;
  std::mt19937 random;

  explicit Fleet(unsigned seed) : random(seed) {}

  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }

  void add_agent(const std::string& name, double gps_sigma) {
    const AgentId agent = AgentId::parse(name).value();
    const Pose T = make_pose(rotation_from_rpy(gauss(0.05), gauss(0.05), gauss(2.0)),
                             Eigen::Vector3d(gauss(50.0), gauss(50.0), gauss(1.0)));
    T_enu_odom[agent] = T;
    for (std::uint32_t k = 0; k < 30; ++k) {
      Node node;
      node.id = {agent, k};
      node.stamp = stamp_from_ns(std::int64_t{k} * 4'000'000'000);
      node.T_odom_base = make_pose(rotation_from_rpy(0.0, 0.0, 0.1 * k),
                                   Eigen::Vector3d(3.0 * k, 10.0 * std::sin(0.2 * k), 0.0));
      const Pose T_enu_base = T * node.T_odom_base;
      const Eigen::Vector3d error(gauss(gps_sigma), gauss(gps_sigma), gauss(gps_sigma));
      node.G.emplace();
      node.G->position = site.to_geo(T_enu_base.translation() + error);
      node.G->q_enu_base = Eigen::Quaterniond(
          Eigen::Matrix3d(site.R_enu_local(node.G->position).transpose() * T_enu_base.linear()));
      node.G->covariance = Matrix6d::Identity() * std::max(1e-6, gps_sigma * gps_sigma);
      node.G->covariance.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() * 1e-4;
      nodes.push_back(node);
    }
  }

  const Node& node(const std::string& agent, std::uint32_t seq) const {
    return *std::ranges::find(nodes, NodeId{AgentId::parse(agent).value(), seq}, &Node::id);
  }

  Pose truth(const Node& n) const { return T_enu_odom.at(n.id.agent) * n.T_odom_base; }

  void align(const Node& i, const Node& j, double rmse, const Pose& error = Pose::Identity()) {
    Alignment a;
    a.i = i.id;
    a.j = j.id;
    a.computed_by = i.id.agent;
    a.seq = static_cast<std::uint32_t>(alignments.size());
    a.modes.front().T_i_j = truth(i).inverse() * truth(j) * error;
    a.modes.front().rmse = rmse;
    alignments.push_back(a);
  }
};

double distance(const Pose& a, const Pose& b) { return se3_log(a.inverse() * b).norm(); }

TEST(Placement, ExactGlobalPosesPlaceEveryNodeExactly) {
  Fleet fleet(1);
  fleet.add_agent("r1", 0.0);
  fleet.add_agent("r2", 0.0);
  const Placement placement = place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site);
  ASSERT_EQ(placement.T_enu_node.size(), fleet.nodes.size());
  for (const Node& node : fleet.nodes)
    EXPECT_LT(distance(placement.T_enu_node.at(node.id), fleet.truth(node)), 1e-6);
  EXPECT_EQ(placement.components.size(), 2u);
}

TEST(Placement, AlignmentFixesTheRelativePoseWhateverTheGpsError) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Fleet fleet(seed);
    fleet.add_agent("r1", 3.0);
    fleet.add_agent("r2", 3.0);
    fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.1);
    const Placement placement = place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site);
    const Node& a = fleet.node("r1", 20);
    const Node& b = fleet.node("r2", 25);
    const Pose placed = placement.T_enu_node.at(a.id).inverse() * placement.T_enu_node.at(b.id);
    EXPECT_LT(distance(placed, fleet.truth(a).inverse() * fleet.truth(b)), 1e-6) << "seed " << seed;
    EXPECT_EQ(placement.components.size(), 1u);
  }
}

TEST(Placement, LeastRmseOfAPairIsKeptAndBadOnesDoNotCount) {
  Fleet fleet(3);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  Pose slip = Pose::Identity();
  slip.translation().x() = 5.0;
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.3, slip);
  fleet.align(fleet.node("r1", 6), fleet.node("r2", 8), 0.1);
  fleet.align(fleet.node("r2", 9), fleet.node("r1", 8), 0.2, slip);
  const Placement placement = place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site);
  ASSERT_EQ(placement.used.size(), 1u);
  EXPECT_EQ(placement.used.front().seq, 1u);

  for (Alignment& a : fleet.alignments) a.modes.front().rmse = 0.5;
  EXPECT_TRUE(place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site).used.empty());
}

TEST(Placement, AmbiguousAlignmentsDoNotCount) {
  Fleet fleet(7);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.1);
  fleet.alignments.front().modes.push_back(fleet.alignments.front().best());
  EXPECT_TRUE(place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site).used.empty());
}

TEST(Placement, SameSetSamePlacementWhateverTheOrder) {
  Fleet fleet(4);
  for (const char* name : {"r1", "r2", "r3", "r4"}) fleet.add_agent(name, 1.5);
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 7), 0.30);
  fleet.align(fleet.node("r3", 5), fleet.node("r2", 9), 0.20);
  fleet.align(fleet.node("r3", 6), fleet.node("r1", 9), 0.25);
  const Placement reference = place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site);
  EXPECT_EQ(reference.components.size(), 2u) << "r4 has no alignment";
  EXPECT_EQ(reference.used.size(), 2u) << "the third alignment would close a loop";
  for (int shuffle = 0; shuffle < 10; ++shuffle) {
    std::ranges::shuffle(fleet.nodes, fleet.random);
    std::ranges::shuffle(fleet.alignments, fleet.random);
    const Placement placement = place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site);
    for (const auto& [id, T] : reference.T_enu_node) {
      EXPECT_TRUE(T.matrix() == placement.T_enu_node.at(id).matrix()) << to_string(id);
    }
  }
}

TEST(Placement, RestartedAgentIsAFrameOfItsOwnUntilAlignedWithItself) {
  Fleet fleet(6);
  fleet.add_agent("r1", 2.0);
  const Pose T_before_after = make_pose(rotation_from_rpy(0.0, 0.0, 1.0), Eigen::Vector3d(4.0, -7.0, 0.5));
  for (Node& node : fleet.nodes) {
    if (node.id.seq < 15) continue;
    node.session = 1;
    node.T_odom_base = T_before_after.inverse() * node.T_odom_base;
  }
  EXPECT_EQ(place_by_least_rmse(fleet.nodes, {}, fleet.site).components.size(), 2u);

  const Node before = fleet.node("r1", 10);
  const Node after = fleet.node("r1", 20);
  Alignment alignment{.i = before.id, .j = after.id, .computed_by = before.id.agent};
  alignment.modes.front().T_i_j = before.T_odom_base.inverse() * T_before_after * after.T_odom_base;
  alignment.modes.front().rmse = 0.1;
  const Placement placement = place_by_least_rmse(fleet.nodes, std::vector{alignment}, fleet.site);
  EXPECT_EQ(placement.components.size(), 1u);
  const Pose placed = placement.T_enu_node.at(fleet.node("r1", 0).id).inverse() *
                      placement.T_enu_node.at(fleet.node("r1", 29).id);
  const Pose truth =
      fleet.node("r1", 0).T_odom_base.inverse() * T_before_after * fleet.node("r1", 29).T_odom_base;
  EXPECT_LT(distance(placed, truth), 1e-6);
}

TEST(Placement, AlignmentOfAnUnknownNodeWaits) {
  Fleet fleet(5);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  fleet.align(fleet.node("r1", 5), fleet.node("r2", 29), 0.1);
  fleet.nodes.pop_back();
  EXPECT_TRUE(place_by_least_rmse(fleet.nodes, fleet.alignments, fleet.site).used.empty());
}

TEST(Placement, NothingInNothingOut) {
  const Placement placement = place_by_least_rmse({}, {}, LocalFrame(kOrigin));
  EXPECT_TRUE(placement.T_enu_node.empty());
  EXPECT_TRUE(placement.components.empty());
}

TEST(GlobalFit, AveragesIndependentErrors) {
  double squared = 0.0;
  constexpr int kRuns = 40;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    Fleet fleet(seed);
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
