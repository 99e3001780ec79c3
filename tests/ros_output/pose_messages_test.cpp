#include "fleetmap/ros_output/pose_messages.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap::ros_output {
namespace {

const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);
constexpr double kQuarter = std::numbers::pi / 2.0;

/// 10 m along its x from where the odometry began, which is 100 m east of the origin and looks north.
graph::PoseNow driven() {
  graph::PoseNow pose;
  pose.stamp = stamp_from_ns(3'000'000'004);
  pose.T_odom_base.translation().x() = 10.0;
  return pose;
}
Pose T_enu_odom() { return make_pose(rotation_from_rpy(0.0, 0.0, kQuarter), {100.0, 0.0, 2.0}); }

graph::PoseNow placed() {
  graph::PoseNow pose = driven();
  pose.placed = graph::PlacedFrame{kOrigin, {}, T_enu_odom(), Matrix6d::Zero(), true};
  pose.placed->covariance.diagonal() << 4.0, 1.0, 9.0, 0.1, 0.2, 0.3;
  return pose;
}

graph::PoseNow located() {
  graph::PoseNow pose = driven();
  const Pose T_enu_base = T_enu_odom() * pose.T_odom_base;
  pose.G.emplace();
  pose.G->position = LocalFrame(kOrigin).to_geo(T_enu_base.translation());
  pose.G->q_enu_base = Eigen::Quaterniond(
      Eigen::Matrix3d(LocalFrame(kOrigin).R_enu_local(pose.G->position).transpose() * T_enu_base.linear()));
  pose.G->covariance.diagonal() << 25.0, 16.0, 9.0, 0.1, 0.2, 0.3;
  return pose;
}

TEST(PoseMessages, TheFramesChainFromTheMapToTheRobotAtTheScansStamp) {
  for (const graph::PoseNow& pose : {placed(), located()}) {
    const auto all = transforms(pose, map_pose(pose, kOrigin));
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].parent + ">" + all[0].child, "odom>base_link");
    EXPECT_EQ(all[1].parent + ">" + all[1].child, "map>odom");
    for (const auto& one : all) EXPECT_EQ(one.stamp, pose.stamp);
    const Pose T_map_base = all[1].T_parent_child * all[0].T_parent_child;
    EXPECT_TRUE(
        T_map_base.isApprox(make_pose(rotation_from_rpy(0.0, 0.0, kQuarter), {100.0, 10.0, 2.0}), 1e-7));
  }
}

TEST(PoseMessages, WithoutAMapOnlyTheOdometryIsPublished) {
  EXPECT_EQ(transforms(driven(), map_pose(driven(), kOrigin)).size(), 1u) << "neither G nor a placement";
  EXPECT_FALSE(map_pose(located(), std::nullopt)) << "G, but no origin";
  EXPECT_FALSE(fused_fix(driven(), std::nullopt));
}

TEST(PoseMessages, ThePlacementGoesBeforeG) {
  graph::PoseNow both = placed();
  both.G = located().G;
  const auto on_map = map_pose(both, kOrigin);
  ASSERT_TRUE(on_map);
  EXPECT_EQ(on_map->covariance, both.placed->covariance);
  const ros_codec::PoseMsg message = pose_message(both, *on_map);
  EXPECT_EQ(message.stamp, both.stamp);
  EXPECT_EQ(message.frame, "map");
  EXPECT_EQ(message.covariance, both.placed->covariance);
  EXPECT_TRUE(message.T_frame_base.isApprox(T_enu_odom() * both.T_odom_base, 1e-12));
}

TEST(PoseMessages, AFixIsThePlaceOnEarthWithTheCovarianceOfItsSource) {
  for (const graph::PoseNow& pose : {placed(), located()}) {
    const auto fix = fused_fix(pose, map_pose(pose, kOrigin));
    ASSERT_TRUE(fix);
    EXPECT_EQ(fix->stamp, pose.stamp);
    EXPECT_LT((LocalFrame(kOrigin).to_enu(fix->position) - Eigen::Vector3d(100.0, 10.0, 2.0)).norm(), 1e-6);
    EXPECT_NEAR(fix->covariance(0, 0), pose.placed ? 4.0 : 25.0, 1e-3);
    EXPECT_NEAR(fix->covariance(1, 1), pose.placed ? 1.0 : 16.0, 1e-3);
  }
}

TEST(PoseMessages, AMapThatLiesNowhereOnEarthGivesNoFix) {
  graph::PoseNow pose = placed();
  pose.placed->georeferenced = false;
  EXPECT_TRUE(map_pose(pose, kOrigin));
  EXPECT_FALSE(fused_fix(pose, map_pose(pose, kOrigin)));
}

/// 60 degrees of longitude away from the origin the axes of ENU are others than those of the map.
TEST(PoseMessages, TheCovarianceOfGIsTurnedIntoTheAxesOfTheMap) {
  graph::PoseNow pose = located();
  const GeoPoint far{kOrigin.latitude, kOrigin.longitude - std::numbers::pi / 3.0, 0.0};
  const auto on_map = map_pose(pose, far);
  ASSERT_TRUE(on_map);
  const Eigen::Matrix3d R = LocalFrame(far).R_enu_local(pose.G->position);
  const Eigen::Matrix3d expected = R * pose.G->covariance.topLeftCorner<3, 3>() * R.transpose();
  EXPECT_TRUE((on_map->covariance.topLeftCorner<3, 3>().isApprox(expected, 1e-9)));
  EXPECT_GT((expected - Eigen::Matrix3d(pose.G->covariance.topLeftCorner<3, 3>())).norm(), 1.0);
  const auto fix = fused_fix(pose, on_map);
  ASSERT_TRUE(fix);
  EXPECT_NEAR(fix->covariance(0, 0), 25.0, 1e-6) << "a fix has those of its own place";
}

}  // namespace
}  // namespace fleetmap::ros_output
