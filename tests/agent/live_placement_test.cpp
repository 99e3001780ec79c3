#include "fleetmap/agent/live_placement.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "agent/placed_pair.hpp"

namespace fleetmap::agent {
namespace {

using LivePlacementTest = testing::PlacedPair;
using testing::kOther;
using testing::kSelf;

TEST_F(LivePlacementTest, ARobotThatNobodyCanPlaceHasNoCorrectedPoseUntilTheFleetPlacesIt) {
  for (std::uint32_t seq = 0; seq < 12; ++seq) add_node(kSelf, seq, false);
  for (std::uint32_t seq = 0; seq < 12; ++seq) add_node(kOther, seq, true);
  solve();
  EXPECT_EQ(used_, std::vector<std::size_t>{0});
  EXPECT_TRUE(heard_at(11).empty());

  for (const std::uint32_t seq : {2u, 6u, 10u}) add_alignment(seq);
  solve();
  EXPECT_EQ(used_.back(), 3u);
  const auto heard = heard_at(11);
  ASSERT_EQ(heard.size(), 1u);
  const Pose T = pose_in(LocalFrame(origin_), heard.front());
  EXPECT_LT((T_enu_node(kSelf, 11).inverse() * T).translation().norm(), 0.3);
  EXPECT_LT(so3_log(T.linear()).norm(), 0.05);
  EXPECT_GT(heard.front().covariance(0, 0), 0.0);
  EXPECT_LT(heard.front().covariance(0, 0), 1.0);
}

TEST_F(LivePlacementTest, FollowsTheOdometryBetweenSolutionsAndIgnoresThatOfAnotherStart) {
  for (std::uint32_t seq = 0; seq < 8; ++seq) add_node(kSelf, seq, true);
  solve();
  const LocalFrame site(origin_);
  const auto at_7 = heard_at(7);
  const auto at_9 = heard_at(9);  // of which there is no node
  ASSERT_TRUE(at_7.size() == 1 && at_9.size() == 1);
  const Eigen::Vector3d moved =
      pose_in(site, at_9.front()).translation() - pose_in(site, at_7.front()).translation();
  EXPECT_LT((moved - Eigen::Vector3d(10.0, 0.0, 0.0)).norm(), 0.05);
  heard_.clear();
  live_->publish({kSelf, 1}, {stamp_from_ns(0), Pose::Identity()});
  network_->run_until(network_->now() + std::chrono::seconds(1));
  EXPECT_TRUE(heard_.empty());
  // Nothing new, nothing solved.
  live_->refresh(0);
  EXPECT_EQ(used_.size(), 1u);
}

}  // namespace
}  // namespace fleetmap::agent
