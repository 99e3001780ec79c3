#include "fleetmap/graph/compute_placement.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fleet_placement.hpp"
#include "fleetmap/graph/located_nodes.hpp"
#include "graph/known_fleet.hpp"
#include "paper_placement.hpp"

namespace fleetmap::graph {
namespace {

using testing::KnownFleet;

PlacementConfig by(PlacementMethod method) {
  PlacementConfig config;
  config.method = method;
  return config;
}

KnownFleet two_robots() {
  KnownFleet fleet(5);
  fleet.add_agent("r1", 1.0);
  fleet.add_agent("r2", 1.0);
  for (std::uint32_t k = 3; k < 24; k += 5) {
    fleet.align(fleet.node("r1", k), fleet.node("r2", k + 2), 0.1);
    fleet.alignments.back().modes.front().covariance = 1e-4 * Matrix6d::Identity();
  }
  for (Node& node : fleet.nodes) node.odom_covariance = 1e-4 * Matrix6d::Identity();
  return fleet;
}

void expect_same_bits(const Placement& placement, const Placement& expected) {
  ASSERT_EQ(placement.T_enu_node.size(), expected.T_enu_node.size());
  for (const auto& [id, T] : expected.T_enu_node)
    EXPECT_TRUE(placement.T_enu_node.at(id).matrix() == T.matrix()) << fleetmap::to_string(id);
  EXPECT_EQ(placement.components, expected.components);
  EXPECT_EQ(placement.used.size(), expected.used.size());
  EXPECT_EQ(placement.outcomes.size(), expected.outcomes.size());
}

TEST(ComputePlacement, TheMethodIsTheConfiguredOne) {
  const KnownFleet fleet = two_robots();
  const Placement graph =
      compute_placement(fleet.nodes, fleet.alignments, fleet.site, by(PlacementMethod::graph));
  expect_same_bits(graph, place_by_fleet_graph(fleet.nodes, fleet.alignments, fleet.site));
  EXPECT_EQ(graph.outcomes.size(), fleet.alignments.size());
  const Placement paper =
      compute_placement(fleet.nodes, fleet.alignments, fleet.site, by(PlacementMethod::paper));
  expect_same_bits(paper, place_by_min_rmse(fleet.nodes, fleet.alignments, fleet.site));
  EXPECT_TRUE(paper.outcomes.empty());
  EXPECT_NE(paper.T_enu_node.begin()->second.matrix(), graph.T_enu_node.begin()->second.matrix());
}

TEST(ComputePlacement, SettingsOfTheMethodAreUsed) {
  const KnownFleet fleet = two_robots();
  PlacementConfig config = by(PlacementMethod::paper);
  EXPECT_EQ(compute_placement(fleet.nodes, fleet.alignments, fleet.site, config).used.size(), 1u);
  config.paper.max_rmse = 0.05;
  EXPECT_TRUE(compute_placement(fleet.nodes, fleet.alignments, fleet.site, config).used.empty());
}

TEST(ComputePlacement, ARobotWithoutGpsIsPlacedByItsAlignments) {
  KnownFleet fleet = two_robots();
  for (Node& node : fleet.nodes) {
    if (node.id.agent.str() == "r2") node.G.reset();
  }
  for (const PlacementMethod method : {PlacementMethod::graph, PlacementMethod::paper}) {
    const Placement placement = compute_placement(fleet.nodes, fleet.alignments, fleet.site, by(method));
    ASSERT_EQ(placement.T_enu_node.size(), fleet.nodes.size()) << to_string(method);
    ASSERT_EQ(placement.components.size(), 1u);
    const Node &a = fleet.node("r1", 13), &b = fleet.node("r2", 15);
    const Pose T_a_b = placement.T_enu_node.at(a.id).inverse() * placement.T_enu_node.at(b.id);
    EXPECT_LT(se3_log(T_a_b.inverse() * fleet.truth(a).inverse() * fleet.truth(b)).norm(), 0.02)
        << to_string(method);
  }
}

/// Located nodes are sorted; the graph sorts by itself.
TEST(ComputePlacement, OneNodeWithoutFixLocatesAsItsOwnStepDoes) {
  KnownFleet fleet = two_robots();
  std::ranges::shuffle(fleet.nodes, fleet.random);
  fleet.nodes[7].G.reset();
  const std::vector<Node> located = with_global_poses(fleet.nodes, fleet.alignments, fleet.site, 60.0);
  expect_same_bits(compute_placement(fleet.nodes, fleet.alignments, fleet.site, by(PlacementMethod::graph)),
                   place_by_fleet_graph(located, fleet.alignments, fleet.site));
}

TEST(ComputePlacement, CovariancesComeOfTheGraphAlone) {
  KnownFleet fleet = two_robots();
  const std::vector<NodeId> wanted{fleet.nodes[4].id, fleet.nodes[40].id};
  const auto covariances = [&](PlacementMethod method) {
    return compute_placement(fleet.nodes, fleet.alignments, fleet.site, by(method), wanted).covariance;
  };
  EXPECT_EQ(covariances(PlacementMethod::graph).size(), 2u);
  EXPECT_TRUE(covariances(PlacementMethod::graph).contains(wanted[1]));
  EXPECT_TRUE(covariances(PlacementMethod::paper).empty());
  fleet.nodes[20].G.reset();
  EXPECT_EQ(covariances(PlacementMethod::graph).size(), 2u);
}

TEST(ComputePlacement, NothingIsPlacedOfNoNodes) {
  const LocalFrame site(testing::kKnownOrigin);
  for (const PlacementMethod method : {PlacementMethod::graph, PlacementMethod::paper}) {
    const Placement placement = compute_placement({}, {}, site, by(method));
    EXPECT_TRUE(placement.T_enu_node.empty());
    EXPECT_TRUE(placement.components.empty());
  }
}

}  // namespace
}  // namespace fleetmap::graph
