#include "candidate_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "loop_closure/two_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::agent;

constexpr double kCell = 25.0;  // m

/// Nodes on Earth and without a fix, and pairs of them.
class CandidateGridTest : public ::testing::Test {
 protected:
  void add_node(const NodeId& id, const Eigen::Vector3d& p_odom, std::optional<GeoPoint> position = {}) {
    graph::Node node = testing::make_node(id.agent, id.seq, Bytes{});
    node.session = session_of(id.seq);
    node.T_odom_base = make_pose(Eigen::Matrix3d::Identity(), p_odom);
    node.G->covariance = 0.01 * Matrix6d::Identity();
    if (position) {
      node.G->position = *position;
    } else {
      node.G.reset();
    }
    ASSERT_TRUE(nodes_.add(node));
  }

  NodeIndex nodes_{kA, 15.0};
  CandidateGrid grid_{kCell, nodes_};
};

TEST_F(CandidateGridTest, AllWhoseOwnNodeIsNearAreFound) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> metres(-100.0, 100.0), coin(0.0, 1.0);
  const GeoPoint origin = geo_point_from_degrees(49.0, 8.4, 110.0);
  constexpr std::uint32_t kNodes = 300;
  for (std::uint32_t k = 0; k < kNodes; ++k) {
    GeoPoint position = origin;
    position.latitude += metres(random) / kMeanEarthRadius;
    position.longitude += metres(random) / (kMeanEarthRadius * std::cos(origin.latitude));
    // Two sessions, whose frames have nothing to do with each other.
    const NodeId id{kA, first_seq(static_cast<std::uint16_t>(k % 2)) + k};
    const Eigen::Vector3d p_odom(metres(random), metres(random), 0.1 * metres(random));
    add_node(id, p_odom, coin(random) < 0.5 ? std::optional(position) : std::nullopt);
    grid_.add({id, {kB, k}});
  }
  std::size_t near = 0, found = 0;
  for (const auto& [node, entry] : nodes_.entries()) {
    const std::set<NodePair> around = grid_.around(node);
    found += around.size();
    for (const auto& [own, other] : nodes_.entries()) {
      if (!nodes_.near(own, node, kCell)) continue;
      ++near;
      EXPECT_TRUE(around.contains({own, {kB, own.seq % kItemsPerSession}})) << to_string(own);
    }
  }
  EXPECT_GT(near, 2 * kNodes);
  EXPECT_LT(found, kNodes * kNodes / 4) << "it is not all of them";
}

TEST_F(CandidateGridTest, CellsBelowZeroAreAsLargeAsOthers) {
  add_node({kA, 0}, {-0.1, -0.1, -0.1});
  add_node({kA, 1}, {14.0, 14.0, 14.0});
  add_node({kA, 2}, {-25.05, 0.0, 0.0});
  add_node({kA, 3}, {0.1, 0.1, 60.0});
  const NodePair pair{{kA, 0}, {kB, 0}};
  grid_.add(pair);
  EXPECT_TRUE(grid_.around({kA, 1}).contains(pair));
  EXPECT_TRUE(grid_.around({kA, 2}).contains(pair));
  EXPECT_FALSE(grid_.around({kA, 3}).contains(pair)) << "three cells above";
  add_node({kA, 4}, {25.1, -0.1, -0.1});
  EXPECT_FALSE(grid_.around({kA, 4}).contains(pair)) << "two cells beside";
}

TEST_F(CandidateGridTest, TheDateLineAndThePolesAreNoBorders) {
  const double near_pole = 0.5 * std::numbers::pi - 5.0 / kMeanEarthRadius;
  add_node({kA, 0}, {0.0, 0.0, 0.0}, GeoPoint{0.1, std::numbers::pi - 5.0 / kMeanEarthRadius, 0.0});
  add_node({kB, 0}, {0.0, 0.0, 0.0}, GeoPoint{0.1, -std::numbers::pi + 5.0 / kMeanEarthRadius, 0.0});
  add_node({kA, 1}, {0.0, 0.0, 0.0}, GeoPoint{near_pole, 0.0, 0.0});
  add_node({kB, 1}, {0.0, 0.0, 0.0}, GeoPoint{near_pole, 3.0, 0.0});
  for (const std::uint32_t seq : {0u, 1u}) grid_.add({{kA, seq}, {kB, seq}});
  for (const std::uint32_t seq : {0u, 1u})
    EXPECT_EQ(grid_.around({kB, seq}), (std::set<NodePair>{NodePair{{kA, seq}, {kB, seq}}})) << seq;
}

TEST_F(CandidateGridTest, FramesOfOtherRobotsAndSessionsAreOtherPlaces) {
  add_node({kA, 0}, {1.0, 1.0, 1.0});
  add_node({kA, first_seq(1)}, {1.0, 1.0, 1.0});
  add_node({kB, 0}, {1.0, 1.0, 1.0});
  const NodePair pair{{kA, 0}, {kB, 9}};
  grid_.add(pair);
  EXPECT_TRUE(grid_.around({kA, 0}).contains(pair));
  EXPECT_TRUE(grid_.around({kA, first_seq(1)}).empty());
  EXPECT_TRUE(grid_.around({kB, 0}).empty());
  EXPECT_TRUE(grid_.around({kB, 77}).empty()) << "an unknown node";
}

TEST_F(CandidateGridTest, APairIsFoundOnceItsOwnNodeCame) {
  const NodePair first{{kA, 3}, {kB, 0}}, second{{kA, 3}, {kB, 8}}, other{{kA, 4}, {kB, 0}};
  for (const NodePair& pair : {second, first, other}) grid_.add(pair);
  add_node({kA, 2}, {0.0, 0.0, 0.0});
  EXPECT_TRUE(grid_.around({kA, 2}).empty());
  add_node({kA, 3}, {1.0, 0.0, 0.0});
  add_node({kA, 4}, {2.0, 0.0, 0.0});
  grid_.on_node({kA, 3});
  EXPECT_EQ(grid_.around({kA, 2}), (std::set<NodePair>{first, second}));
  grid_.on_node({kA, 3});
  grid_.on_node({kA, 4});
  EXPECT_EQ(grid_.around({kA, 2}), (std::set<NodePair>{first, second, other}));
}

TEST_F(CandidateGridTest, ErasedPairsAreNotFound) {
  const GeoPoint position = geo_point_from_degrees(49.0, 8.4, 110.0);
  add_node({kA, 0}, {0.0, 0.0, 0.0}, position);
  const NodePair first{{kA, 0}, {kB, 0}}, second{{kA, 0}, {kB, 1}}, waiting{{kA, 1}, {kB, 0}};
  for (const NodePair& pair : {first, second, waiting}) grid_.add(pair);
  grid_.erase(first);
  grid_.erase(first);
  grid_.erase(waiting);
  EXPECT_EQ(grid_.around({kA, 0}), (std::set<NodePair>{second}));
  add_node({kA, 1}, {0.0, 0.0, 0.0}, position);
  grid_.on_node({kA, 1});
  EXPECT_EQ(grid_.around({kA, 1}), (std::set<NodePair>{second}));
  grid_.add(first);
  EXPECT_EQ(grid_.around({kA, 0}), (std::set<NodePair>{first, second}));
}

}  // namespace
}  // namespace fleetmap::loop_closure
