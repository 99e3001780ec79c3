#include "odometry_candidates.hpp"

#include <gtest/gtest.h>

#include "loop_closure/own_sessions.hpp"

namespace fleetmap::loop_closure {
namespace {

graph::Node odometry_node(std::uint32_t seq, double x, double y, std::uint16_t session = 0) {
  graph::Node node;
  node.id = {kSelf, seq};
  node.session = session;
  node.T_odom_base.translation() = Eigen::Vector3d(x, y, 0.0);
  node.odom_covariance = Vector6d(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
  return node;
}

/// Up one lane of 100 m and down the next, `pitch` beside it, a node every 4 m.
std::vector<LoopCandidate> candidates_of_two_lanes(OdometryCandidates& candidates, double pitch) {
  std::vector<LoopCandidate> found;
  std::uint32_t seq = 0;
  const auto offer = [&](double x, double y) {
    if (auto candidate = candidates.propose(odometry_node(seq++, x, y))) found.push_back(*candidate);
  };
  for (int k = 0; k <= 25; ++k) offer(4.0 * k, 0.0);
  for (int k = 25; k >= 0; --k) offer(4.0 * k, pitch);
  return found;
}

TEST(OdometryCandidates, FindTheLaneBesideOnceTheRobotHasDrivenFarEnough) {
  const OwnPathConfig config;
  OdometryCandidates candidates(config);
  const auto found = candidates_of_two_lanes(candidates, 7.0);
  ASSERT_GE(found.size(), 3u);
  EXPECT_LE(found.size(), 7u);  // about 70 m at one in 20
  for (const LoopCandidate& candidate : found) {
    const Eigen::Vector3d apart = candidate.T_target_source->T_a_b.translation();
    EXPECT_NEAR(apart.x(), 0.0, 1e-9) << "the nearest one";
    EXPECT_NEAR(apart.y(), 7.0, 1e-9);
    EXPECT_GE(4.0 * (candidate.source.seq - candidate.target.seq - 1) + 7.0, config.min_path);
  }
}

/// Every sixth row of a farm with 7 m between rows; the lane's end behind the robot is no place it came back
/// to.
TEST(OdometryCandidates, TieLanesThatShareTheRowsBetweenThem) {
  OdometryCandidates candidates(OwnPathConfig{});
  const auto found = candidates_of_two_lanes(candidates, 42.0);
  ASSERT_GE(found.size(), 3u);
  for (const LoopCandidate& candidate : found) {
    const Eigen::Vector3d apart = candidate.T_target_source->T_a_b.translation();
    EXPECT_NEAR(apart.x(), 0.0, 1e-9);
    EXPECT_NEAR(apart.y(), 42.0, 1e-9);
  }
}

TEST(OdometryCandidates, NeedSurroundingsThatReachEachOther) {
  OdometryCandidates candidates(OwnPathConfig{});
  EXPECT_TRUE(candidates_of_two_lanes(candidates, 46.0).empty());
}

TEST(OdometryCandidates, UncertaintyGrowsAlongThePathAndAcrossByTheHeading) {
  OdometryCandidates candidates(OwnPathConfig{});
  const auto found = candidates_of_two_lanes(candidates, 7.0);
  ASSERT_FALSE(found.empty());
  const LoopCandidate& last = found.back();
  const double steps = last.source.seq - last.target.seq;
  const Matrix6d& covariance = last.T_target_source->covariance;
  EXPECT_NEAR(covariance(3, 3), steps * 1e-6, 1e-12);
  EXPECT_GT(covariance(1, 1), steps * 1e-4);
  EXPECT_TRUE(covariance.isApprox(covariance.transpose()));
}

TEST(OdometryCandidates, DoNotReachIntoAnotherOdometryFrame) {
  OdometryCandidates candidates(OwnPathConfig{});
  for (std::uint32_t k = 0; k <= 25; ++k) EXPECT_FALSE(candidates.propose(odometry_node(k, 4.0 * k, 0.0)));
  for (std::uint32_t k = 0; k <= 25; ++k) {
    EXPECT_FALSE(candidates.propose(odometry_node(26 + k, 100.0 - 4.0 * k, 5.0, 1)));
  }
}

TEST(OdometryCandidates, SettingsThatCannotBeAreRefused) {
  OwnPathConfig config;
  EXPECT_TRUE(config.validate());
  config.min_path = 5.0;
  EXPECT_FALSE(config.validate());
}

}  // namespace
}  // namespace fleetmap::loop_closure
