#include "twin/twin_truth.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "apps/flat_site.hpp"

namespace fleetmap::apps {
namespace {

using std::chrono::milliseconds;

const Stamp kTwinStart = stamp_from_ns(1'000'000'000);

sim::RobotTwin twin_at(const Eigen::Vector2d& start, double yaw) {
  sim::RobotTwinConfig config = flat_site_robot();
  config.start = start;
  config.start_yaw = yaw;
  return sim::RobotTwin::create(flat_site(), kFlatSiteOrigin, config, kTwinStart).value();
}

TEST(TwinTruth, ATrackHasAPoseEvery20Milliseconds) {
  sim::RobotTwin twin = twin_at({0.0, 0.0}, 0.0);
  TruthTrack track;
  track.follow(twin);
  for (int k = 0; k < 100; ++k) {
    twin.command(1.0, 0.0);
    twin.advance(twin.now() + milliseconds(5));
    track.follow(twin);
  }
  const output::Trajectory& poses = track.poses();
  ASSERT_EQ(poses.size(), 26u);
  for (std::size_t k = 1; k < poses.size(); ++k)
    EXPECT_EQ(poses[k].stamp - poses[k - 1].stamp, milliseconds(20));
  EXPECT_EQ(poses.back().T_w_base.matrix(), twin.T_enu_base().matrix());
  EXPECT_GT(poses.back().T_w_base.translation().x(), 0.1);
}

TEST(TwinTruth, TheTruePoseIsThatOfTheTwinOnEarth) {
  const sim::RobotTwin twin = twin_at({15.0, -8.0}, 0.7);
  const LocalFrame site(kFlatSiteOrigin);
  const GlobalPose pose = true_pose(twin, site);
  EXPECT_EQ(pose.stamp, twin.now());
  EXPECT_LT((site.to_enu(pose.position) - twin.T_enu_base().translation()).norm(), 1e-6);
  // Some metres from the origin, up and north have turned by some microradians.
  const Eigen::Quaterniond expected(twin.T_enu_base().linear());
  EXPECT_LT(pose.q_enu_base.angularDistance(expected), 1e-5);
  EXPECT_TRUE(pose.covariance.isZero());
}

TEST(TwinTruth, TheBatteryIsAShareOfItsCapacity) {
  sim::RobotTwin twin = twin_at({0.0, 0.0}, 0.0);
  EXPECT_DOUBLE_EQ(battery_share(twin), 1.0);
  for (int k = 0; k < 50; ++k) {
    twin.command(1.0, 0.0);
    twin.advance(twin.now() + milliseconds(100));
  }
  const double share = battery_share(twin);
  EXPECT_LT(share, 1.0);
  EXPECT_DOUBLE_EQ(share, twin.battery_wh() / twin.config().vehicle.battery_wh);
}

}  // namespace
}  // namespace fleetmap::apps
