#include "fleetmap/ros_codec/poses.hpp"

#include <gtest/gtest.h>

#include "fleetmap/bus/cdr.hpp"
#include "nav_msgs.h"
#include "tf2_msgs.h"

namespace fleetmap::ros_codec {
namespace {

const Stamp kStamp = stamp_from_ns(1'700'000'000'000'000'007);
const Pose kPose = make_pose(rotation_from_rpy(0.1, -0.2, 0.3), {1.0, 2.0, 3.0});

Pose pose_of(const geometry_msgs::msg::dds_::Pose_& pose) {
  const auto& q = pose.orientation();
  return make_pose(Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()),
                   {pose.position().x(), pose.position().y(), pose.position().z()});
}
std::int64_t ns_of(const std_msgs::msg::dds_::Header_& header) {
  return header.stamp().sec() * 1'000'000'000LL + header.stamp().nanosec();
}

TEST(Poses, ATransformKeepsItsStampItsFramesAndItsDirection) {
  const Bytes cdr = encode(std::vector<StampedTransform>{{kStamp, "map", "odom", kPose}});
  const auto back = bus::from_cdr<tf2_msgs::msg::dds_::TFMessage_>(cdr, "TFMessage");
  ASSERT_TRUE(back && back->transforms().size() == 1);
  const auto& one = back->transforms()[0];
  EXPECT_EQ(ns_of(one.header()), to_ns(kStamp));
  EXPECT_EQ(one.header().frame_id() + ">" + one.child_frame_id(), "map>odom");
  const auto& t = one.transform().translation();
  const auto& q = one.transform().rotation();
  EXPECT_TRUE(make_pose(Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()), {t.x(), t.y(), t.z()})
                  .isApprox(kPose, 1e-12));
}

TEST(Poses, APoseKeepsItsCovarianceRowByRow) {
  PoseMsg pose{kStamp, "map", kPose, Matrix6d::Identity()};
  pose.covariance(0, 5) = 0.5;
  const auto back = bus::from_cdr<geometry_msgs::msg::dds_::PoseWithCovarianceStamped_>(encode(pose), "Pose");
  ASSERT_TRUE(back);
  EXPECT_EQ(ns_of(back->header()), to_ns(kStamp));
  EXPECT_TRUE(pose_of(back->pose().pose()).isApprox(kPose, 1e-12));
  EXPECT_EQ(back->pose().covariance()[5], 0.5);
  EXPECT_EQ(back->pose().covariance()[30], 0.0);
}

TEST(Poses, APathHasTheStampOfItsLastPlace) {
  const PathMsg path{"map", {{stamp_from_ns(5), Pose::Identity()}, {kStamp, kPose}}};
  const auto back = bus::from_cdr<nav_msgs::msg::dds_::Path_>(encode(path), "Path");
  ASSERT_TRUE(back && back->poses().size() == 2);
  EXPECT_EQ(ns_of(back->header()), to_ns(kStamp));
  EXPECT_EQ(back->header().frame_id(), "map");
  EXPECT_EQ(ns_of(back->poses()[0].header()), 5);
  EXPECT_TRUE(pose_of(back->poses()[1].pose()).isApprox(kPose, 1e-12));
  EXPECT_TRUE(bus::from_cdr<nav_msgs::msg::dds_::Path_>(encode(PathMsg{}), "Path"));
}

}  // namespace
}  // namespace fleetmap::ros_codec
