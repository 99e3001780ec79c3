#include "fleetmap/agent/loop_closures.hpp"

#include <gtest/gtest.h>

namespace fleetmap::agent {
namespace {

const AgentId kSelf = *AgentId::parse("r1");

graph::Node node_at(std::uint32_t seq, double x, double y, std::uint16_t session = 0) {
  graph::Node node;
  node.id = {kSelf, seq};
  node.session = session;
  node.T_odom_base.translation() = Eigen::Vector3d(x, y, 0.0);
  node.odom_covariance = Vector6d(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
  return node;
}

/// Up one lane of 100 m and down the next, `pitch` beside it, a node every 4 m.
std::vector<LoopClosure> closures_of_two_lanes(LoopClosures& closures, double pitch) {
  std::vector<LoopClosure> found;
  std::uint32_t seq = 0;
  const auto offer = [&](double x, double y) {
    if (auto closure = closures.on_own_node(node_at(seq++, x, y))) found.push_back(*closure);
  };
  for (int k = 0; k <= 25; ++k) offer(4.0 * k, 0.0);
  for (int k = 25; k >= 0; --k) offer(4.0 * k, pitch);
  return found;
}

TEST(LoopClosures, FindTheLaneBesideOnceTheRobotHasDrivenFarEnough) {
  const LoopClosureConfig config;
  LoopClosures closures(config);
  const auto found = closures_of_two_lanes(closures, 7.0);
  ASSERT_GE(found.size(), 3u);
  EXPECT_LE(found.size(), 7u);  // about 70 m at one in 20
  for (const LoopClosure& closure : found) {
    const Eigen::Vector3d apart =
        closure.later.T_odom_base.translation() - closure.earlier.T_odom_base.translation();
    EXPECT_NEAR(apart.x(), 0.0, 1e-9) << "the nearest one";
    EXPECT_NEAR(apart.y(), 7.0, 1e-9);
    EXPECT_GE(4.0 * (closure.later.id.seq - closure.earlier.id.seq - 1) + 7.0, config.min_path);
  }
}

/// Every sixth row of a farm with 7 m between rows; the lane's end behind the robot is no place it came back
/// to.
TEST(LoopClosures, TieLanesThatShareTheRowsBetweenThem) {
  LoopClosures closures(LoopClosureConfig{});
  const auto found = closures_of_two_lanes(closures, 42.0);
  ASSERT_GE(found.size(), 3u);
  for (const LoopClosure& closure : found) {
    const Eigen::Vector3d apart =
        closure.later.T_odom_base.translation() - closure.earlier.T_odom_base.translation();
    EXPECT_NEAR(apart.x(), 0.0, 1e-9);
    EXPECT_NEAR(apart.y(), 42.0, 1e-9);
  }
}

TEST(LoopClosures, NeedSurroundingsThatReachEachOther) {
  LoopClosures closures(LoopClosureConfig{});
  EXPECT_TRUE(closures_of_two_lanes(closures, 46.0).empty());
}

TEST(LoopClosures, UncertaintyGrowsAlongThePathAndAcrossByTheHeading) {
  LoopClosures closures(LoopClosureConfig{});
  const auto found = closures_of_two_lanes(closures, 7.0);
  ASSERT_FALSE(found.empty());
  const LoopClosure& last = found.back();
  const double steps = last.later.id.seq - last.earlier.id.seq;
  EXPECT_NEAR(last.covariance(3, 3), steps * 1e-6, 1e-12);
  EXPECT_GT(last.covariance(1, 1), steps * 1e-4);
  EXPECT_TRUE(last.covariance.isApprox(last.covariance.transpose()));
}

TEST(LoopClosures, DoNotReachIntoAnotherOdometryFrame) {
  LoopClosures closures(LoopClosureConfig{});
  for (std::uint32_t k = 0; k <= 25; ++k) EXPECT_FALSE(closures.on_own_node(node_at(k, 4.0 * k, 0.0)));
  for (std::uint32_t k = 0; k <= 25; ++k) {
    EXPECT_FALSE(closures.on_own_node(node_at(26 + k, 100.0 - 4.0 * k, 5.0, 1)));
  }
}

TEST(LoopClosures, SettingsThatCannotBeAreRefused) {
  LoopClosureConfig config;
  EXPECT_TRUE(config.validate());
  config.min_path = 5.0;
  EXPECT_FALSE(config.validate());
}

}  // namespace
}  // namespace fleetmap::agent
