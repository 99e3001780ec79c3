#include "session_candidates.hpp"

#include <gtest/gtest.h>

#include <map>

#include "loop_closure/own_sessions.hpp"
#include "loop_closure/two_robots.hpp"
#include "registration_prior.hpp"
#include "support/walled_site.hpp"

namespace fleetmap::loop_closure {
namespace {

using testing::node_at_walls;

/// East along y = 0 in the first session; the second begins 40 m on and drives back, 2 m beside.
graph::Node of_first(std::uint32_t seq) {
  graph::Node node = node_at_walls(kSelf, seq, pose(30.0, 70.0, 1.0), pose(-60.0 + 10.0 * seq, 0.0, 0.0));
  node.session = 0;
  return node;
}
Pose true_pose_of_second(std::uint32_t seq) { return pose(40.0 - 10.0 * (seq - 12), 2.0, 3.1); }
graph::Node of_second(std::uint32_t seq) {
  graph::Node node = node_at_walls(kSelf, seq, pose(-8.0, 300.0, -2.0), true_pose_of_second(seq));
  node.session = 1;
  return node;
}

/// As an EKF would say, with an error of `sigma` m that it knows of.
void locate(graph::Node& node, const Eigen::Vector3d& p_enu, double sigma) {
  GlobalPose G;
  G.position = LocalFrame(kOrigin).to_geo(p_enu);
  G.covariance.diagonal() << sigma * sigma, sigma * sigma, sigma * sigma, 1e-4, 1e-4, 1e-3;
  node.G = G;
}

class SessionCandidatesTest : public ::testing::Test {
 protected:
  void begin(const CandidateConfig& config = {}) {
    sessions_.emplace(config);
    std::vector<const graph::Node*> earlier;
    for (const graph::Node& node : first_) earlier.push_back(&node);
    sessions_->begin(earlier);
  }
  const graph::Node& earlier_of(const LoopCandidate& candidate) const {
    return first_.at(candidate.target.seq);
  }
  registration::Prior prior_of(const LoopCandidate& candidate, const graph::Node& node) const {
    return registration_prior(candidate, earlier_of(candidate), node, {}).value();
  }
  /// Drives the second session and accepts every registration; a candidate is right if its prior is to 4 m.
  std::pair<int, int> right_and_wrong() {
    std::pair<int, int> found(0, 0);
    for (const graph::Node& node : second_) {
      const auto candidate = sessions_->propose(node);
      if (!candidate) continue;
      EXPECT_EQ(earlier_of(*candidate).session, 0);
      const Pose truth =
          pose(-60.0 + 10.0 * candidate->target.seq, 0.0, 0.0).inverse() * true_pose_of_second(node.id.seq);
      const bool right =
          (prior_of(*candidate, node).T_target_source.translation() - truth.translation()).norm() < 4.0;
      ++(right ? found.first : found.second);
      sessions_->on_accepted(earlier_of(*candidate), node);
    }
    return found;
  }

  std::vector<graph::Node> first_ = [] {
    std::vector<graph::Node> nodes;
    for (std::uint32_t seq = 0; seq < 12; ++seq) nodes.push_back(of_first(seq));
    return nodes;
  }();
  std::vector<graph::Node> second_ = [] {
    std::vector<graph::Node> nodes;
    for (std::uint32_t seq = 12; seq < 22; ++seq) nodes.push_back(of_second(seq));
    return nodes;
  }();
  std::optional<SessionCandidates> sessions_;
};

TEST_F(SessionCandidatesTest, WithoutGpsThreeDescriptorMatchesJoinTheNewSession) {
  begin();
  const auto [right, wrong] = right_and_wrong();
  EXPECT_EQ(right, 3);
  EXPECT_EQ(wrong, 0);
}

TEST_F(SessionCandidatesTest, WithGpsTheNearestNodeDoesAndOnceIsEnough) {
  for (graph::Node& node : first_) locate(node, {-60.0 + 10.0 * node.id.seq, 0.0, 0.0}, 1.0);
  for (graph::Node& node : second_) locate(node, true_pose_of_second(node.id.seq).translation(), 1.0);
  begin();
  const auto candidate = sessions_->propose(second_.front());
  ASSERT_TRUE(candidate);
  EXPECT_EQ(candidate->target.seq, 10u) << "40 m east";
  EXPECT_TRUE(sessions_->propose(second_[1])) << "the first may have been rejected";
  sessions_->on_accepted(earlier_of(*candidate), second_.front());
  for (std::size_t k = 2; k < second_.size(); ++k) EXPECT_FALSE(sessions_->propose(second_[k])) << k;
}

TEST_F(SessionCandidatesTest, AnUncertainGCountsAsNone) {
  for (graph::Node& node : first_) locate(node, {5000.0, 0.0, 0.0}, 1.0);
  for (graph::Node& node : second_) locate(node, {0.0, 0.0, 0.0}, 500.0);
  begin();
  EXPECT_EQ(right_and_wrong(), std::pair(3, 0));
}

TEST_F(SessionCandidatesTest, ASessionJoinedByDescriptorIsJoinedByPositionOnceGpsComes) {
  for (graph::Node& node : first_) locate(node, {-60.0 + 10.0 * node.id.seq, 0.0, 0.0}, 1.0);
  begin();
  std::size_t k = 0;
  for (; k < 5; ++k) {
    if (const auto candidate = sessions_->propose(second_[k]))
      sessions_->on_accepted(earlier_of(*candidate), second_[k]);
  }
  locate(second_[k], true_pose_of_second(second_[k].id.seq).translation(), 1.0);
  const auto candidate = sessions_->propose(second_[k]);
  ASSERT_TRUE(candidate);
  EXPECT_LT(prior_of(*candidate, second_[k]).sigma_translation_m, 2.5) << "by G, and not by descriptor";
  sessions_->on_accepted(earlier_of(*candidate), second_[k]);
  for (++k; k < second_.size(); ++k)
    EXPECT_FALSE(sessions_->propose(second_[k])) << "joined, whatever matches";
}

TEST_F(SessionCandidatesTest, EveryEarlierSessionIsJoined) {
  for (std::size_t k = 0; k < first_.size(); k += 2) first_[k].session = 1;
  for (graph::Node& node : second_) node.session = 2;
  begin();
  std::map<int, int> joined;
  for (const graph::Node& node : second_) {
    const auto candidate = sessions_->propose(node);
    if (!candidate) continue;
    ++joined[earlier_of(*candidate).session];
    sessions_->on_accepted(earlier_of(*candidate), node);
  }
  EXPECT_EQ(joined[0], 3);
  EXPECT_EQ(joined[1], 3);
}

TEST_F(SessionCandidatesTest, TheFirstSessionHasNothingToJoin) {
  first_.clear();
  begin();
  EXPECT_EQ(right_and_wrong(), std::pair(0, 0));
}

TEST_F(SessionCandidatesTest, ANodeFarFromAllEarlierOnesIsNoCandidate) {
  for (graph::Node& node : first_) locate(node, {-60.0 + 10.0 * node.id.seq, 0.0, 0.0}, 1.0);
  begin();
  graph::Node far = second_.front();
  locate(far, {900.0, 900.0, 0.0}, 1.0);
  EXPECT_FALSE(sessions_->propose(far));
}

}  // namespace
}  // namespace fleetmap::loop_closure
