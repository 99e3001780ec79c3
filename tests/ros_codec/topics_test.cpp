#include "fleetmap/ros_codec/topics.hpp"

#include <gtest/gtest.h>

namespace fleetmap::ros_codec {
namespace {

TEST(RosTopics, NamesAndTypesAreThoseOfRos2) {
  EXPECT_EQ(topics::points().name, "rt/points");
  EXPECT_EQ(topics::points().type, "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_EQ(topics::fix().type, "sensor_msgs::msg::dds_::NavSatFix_");
  EXPECT_EQ(topics::tf_static().name, "rt/tf_static");
  EXPECT_EQ(topics::tf_static().type, "tf2_msgs::msg::dds_::TFMessage_");
  EXPECT_EQ(topics::imu().type, "sensor_msgs::msg::dds_::Imu_");
  EXPECT_EQ(topics::odometry().type, "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(topics::cmd_vel().type, "geometry_msgs::msg::dds_::Twist_");
}

}  // namespace
}  // namespace fleetmap::ros_codec
