#include "ros_geometry.hpp"

#include <gtest/gtest.h>

namespace fleetmap::ros_codec {
namespace {

TEST(RosGeometry, ConversionsAreInverse) {
  const Eigen::Vector3d v(1.0, -2.0, 3.0);
  EXPECT_EQ(from_ros(to_ros(v)), v);
  const Eigen::Quaterniond q(rotation_from_rpy(0.1, -0.2, 0.3));
  EXPECT_EQ(from_ros(to_ros(q)).coeffs(), q.coeffs());
  Matrix6d covariance;
  for (int k = 0; k < 36; ++k) covariance(k / 6, k % 6) = k;
  EXPECT_EQ(covariance_from_ros(to_ros(covariance)), covariance);
  EXPECT_EQ(to_ros(covariance)[7], covariance(1, 1)) << "row by row";
}

TEST(RosGeometry, APoseIsItsPositionAndItsRotation) {
  const auto pose = to_ros(make_pose(rotation_from_rpy(0.0, 0.0, 1.0), {4.0, 5.0, 6.0}));
  EXPECT_EQ(pose.position().y(), 5.0);
  EXPECT_NEAR(pose.orientation().z(), std::sin(0.5), 1e-12);
  EXPECT_NEAR(pose.orientation().w(), std::cos(0.5), 1e-12);
  const auto head = header(stamp_from_ns(2'000'000'003), "map");
  EXPECT_EQ(head.stamp().sec(), 2);
  EXPECT_EQ(head.stamp().nanosec(), 3u);
  EXPECT_EQ(head.frame_id(), "map");
}

}  // namespace
}  // namespace fleetmap::ros_codec
