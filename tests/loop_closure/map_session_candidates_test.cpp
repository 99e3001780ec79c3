#include "map_session_candidates.hpp"

#include <gtest/gtest.h>

#include <set>

#include "loop_closure/own_sessions.hpp"
#include "loop_closure/two_robots.hpp"
#include "registration_prior.hpp"
#include "support/walled_site.hpp"

namespace fleetmap::loop_closure {
namespace {

Pose true_pose_of(std::uint32_t seq, bool second) {
  return second ? pose(60.0 - 10.0 * seq, 2.0, 3.1) : pose(-60.0 + 10.0 * seq, 0.0, 0.0);
}

/// One way east, and on another day the same way back.
class MapSessionCandidatesTest : public ::testing::Test {
 protected:
  MapSessionCandidatesTest() {
    for (std::uint32_t seq = 0; seq < 12; ++seq) {
      first_.push_back(node_at(seq, pose(30.0, 70.0, 1.0), false));
      second_.push_back(node_at(seq, pose(-8.0, 300.0, -2.0), true));
    }
  }
  static graph::Node node_at(std::uint32_t seq, const Pose& T_enu_odom, bool second) {
    graph::Node node = testing::node_at_walls(kSelf, seq, T_enu_odom, true_pose_of(seq, second));
    node.session = second ? 1 : 0;
    node.id.seq += first_seq(node.session);
    return node;
  }
  static void locate(std::vector<graph::Node>& nodes, const Eigen::Vector3d& error) {
    for (graph::Node& node : nodes) {
      const Pose T = true_pose_of(node.id.seq - first_seq(node.session), node.session == 1);
      GlobalPose G;
      G.position = LocalFrame(kOrigin).to_geo(T.translation() + error);
      G.covariance.diagonal() << 4.0, 4.0, 4.0, 1e-4, 1e-4, 1e-3;
      node.G = G;
    }
  }
  MapSessionCandidates find(double spacing_m = 10.0) const {
    CandidateConfig config;
    config.spacing_m = spacing_m;
    Track first, second;
    for (const graph::Node& node : first_) first.push_back(&node);
    for (const graph::Node& node : second_) second.push_back(&node);
    return candidates_between(first, second, config);
  }
  double true_distance(const LoopCandidate& candidate) const {
    const Pose a = true_pose_of(candidate.target.seq, false);
    const Pose b = true_pose_of(candidate.source.seq - first_seq(1), true);
    return (a.translation() - b.translation()).norm();
  }

  std::vector<graph::Node> first_, second_;
};

TEST_F(MapSessionCandidatesTest, ByGpsTheNearestOfEachPlaceOneASpacing) {
  locate(first_, {0.0, 0.0, 0.0});
  locate(second_, {1.0, 1.5, 3.0});
  const MapSessionCandidates found = find(15.0);
  // 110 m of common way with a node each 10 m, so a candidate each 20 m.
  EXPECT_GE(found.candidates.size(), 5u);
  EXPECT_LE(found.candidates.size(), 7u);
  EXPECT_GT(find(5.0).candidates.size(), 9u);
  for (const LoopCandidate& candidate : found.candidates) {
    EXPECT_EQ(session_of(candidate.target.seq), 0);
    EXPECT_EQ(session_of(candidate.source.seq), 1);
    EXPECT_EQ(candidate.origin, LoopCandidate::Origin::kPosition);
    EXPECT_LT(true_distance(candidate), 10.0);
  }
  ASSERT_TRUE(found.nearest_m);
  EXPECT_NEAR(*found.nearest_m, 3.6, 0.5);
}

TEST_F(MapSessionCandidatesTest, WithoutGpsByDescriptor) {
  const MapSessionCandidates found = find();
  EXPECT_FALSE(found.nearest_m);
  ASSERT_GE(found.candidates.size(), 3u);
  for (const LoopCandidate& candidate : found.candidates) {
    EXPECT_EQ(candidate.origin, LoopCandidate::Origin::kDescriptor);
    EXPECT_EQ(session_of(candidate.target.seq), 0);
    EXPECT_LT(true_distance(candidate), 15.0);
  }
}

TEST_F(MapSessionCandidatesTest, WaysThatAreFarApartHaveNoneAndTheDistanceIsKnown) {
  locate(first_, {0.0, 0.0, 0.0});
  locate(second_, {0.0, 500.0, 0.0});
  const MapSessionCandidates found = find();
  EXPECT_TRUE(found.candidates.empty());
  ASSERT_TRUE(found.nearest_m);
  EXPECT_NEAR(*found.nearest_m, 502.0, 3.0);
}

}  // namespace
}  // namespace fleetmap::loop_closure
