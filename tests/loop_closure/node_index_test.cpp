#include "node_index.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::agent;

graph::Node indexed_node(const char* name, std::uint32_t seq, double east_m, bool located = true) {
  auto node = testing::make_node(agent(name), seq, Bytes{}, east_m);
  node.G->covariance = 0.01 * Matrix6d::Identity();
  node.T_odom_base = make_pose(Eigen::Matrix3d::Identity(), {east_m, 0.0, 0.0});
  if (!located) node.G.reset();
  return node;
}
NodeId id(const char* name, std::uint32_t seq) { return {agent(name), seq}; }

TEST(NodeIndex, CountsTheNodesThatFollowInTheSameSession) {
  NodeIndex nodes(agent("a"), 15.0);
  for (const std::uint32_t seq : {4u, 2u, 3u}) EXPECT_TRUE(nodes.add(indexed_node("b", seq, 0.0)));
  EXPECT_FALSE(nodes.add(indexed_node("b", 3, 0.0))) << "known";
  EXPECT_EQ(nodes.nodes_after(id("b", 2)), 2u);
  EXPECT_EQ(nodes.nodes_after(id("b", 4)), 0u);
  EXPECT_EQ(nodes.nodes_after(id("b", 9)), 0u) << "unknown";
}

TEST(NodeIndex, DistancesAreOfGOrWithinOneOdometryFrame) {
  NodeIndex nodes(agent("a"), 15.0);
  nodes.add(indexed_node("a", 0, 0.0));
  nodes.add(indexed_node("b", 0, 6.0));
  nodes.add(indexed_node("b", 1, 9.0, false));
  EXPECT_TRUE(nodes.near(id("a", 0), id("b", 0), 6.5));
  EXPECT_FALSE(nodes.near(id("a", 0), id("b", 0), 5.5));
  EXPECT_TRUE(nodes.near(id("b", 0), id("b", 1), 3.5));
  EXPECT_FALSE(nodes.near(id("a", 0), id("b", 1), 1e3)) << "of two frames";
  EXPECT_TRUE(nodes.any_unlocated());
  EXPECT_TRUE(nodes.lacks_position({id("a", 0), id("b", 1)}));
  EXPECT_FALSE(nodes.lacks_position({id("a", 0), id("b", 0)}));
  nodes.remove(id("b", 1));
  EXPECT_FALSE(nodes.lacks_position({id("a", 0), id("b", 1)}));
}

TEST(NodeIndex, OwnNodesFormPairsWithAllPeersAndTheirsWithOurs) {
  NodeIndex nodes(agent("b"), 15.0);
  for (const char* name : {"c", "b", "a"}) nodes.add(indexed_node(name, 0, 0.0));
  EXPECT_EQ(nodes.partners_of(agent("b")), (std::vector<AgentId>{agent("a"), agent("c")}));
  EXPECT_EQ(nodes.partners_of(agent("c")), (std::vector<AgentId>{agent("b")}));
}

}  // namespace
}  // namespace fleetmap::loop_closure
