#include "ros_names.hpp"

#include <gtest/gtest.h>

namespace fleetmap::recording {
namespace {

TEST(RosNames, TopicsOfDdsAndOfRosAreTheSame) {
  EXPECT_EQ(ros_topic("rt/points"), "/points");
  EXPECT_EQ(ros_topic("rt/r1/imu"), "/r1/imu");
  EXPECT_EQ(ros_topic("/points"), "/points");
  EXPECT_EQ(ros_topic("points"), "/points");
  EXPECT_EQ(ros_topic("rt"), "/rt") << "only a prefix with its slash is one";
  EXPECT_EQ(ros_topic("/rt/points"), "/rt/points");
}

TEST(RosNames, TypesOfDdsAndOfRosAreTheSame) {
  EXPECT_EQ(ros_type("sensor_msgs::msg::dds_::Imu_"), "sensor_msgs/msg/Imu");
  EXPECT_EQ(ros_type("fleetmap::msg::Node"), "fleetmap/msg/Node");
  EXPECT_EQ(ros_type("sensor_msgs/msg/Imu"), "sensor_msgs/msg/Imu");
  EXPECT_EQ(ros_type("a::msg::Kept_"), "a/msg/Kept_") << "the underscore at the end is DDS's alone";
  EXPECT_EQ(ros_type(""), "");
  EXPECT_EQ(ros_type("::"), "/");
}

}  // namespace
}  // namespace fleetmap::recording
