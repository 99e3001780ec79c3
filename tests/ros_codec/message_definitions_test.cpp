#include "fleetmap/ros_codec/message_definitions.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::ros_codec {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kSeparator(80, '=');

TEST(MessageDefinitions, MembersHaveTheNamesOfMsgFiles) {
  EXPECT_EQ(message_definition("builtin_interfaces/msg/Time"),
            "int32 sec  # s since the Unix epoch\nuint32 nanosec  # ns, [0, 10^9)\n");
  const std::string fix = message_definition("sensor_msgs/msg/NavSatFix");
  EXPECT_THAT(fix,
              StartsWith("std_msgs/Header header  # frame: the antenna\nsensor_msgs/NavSatStatus status\n"
                         "float64 latitude"));
  EXPECT_THAT(fix, HasSubstr("\nfloat64[9] position_covariance  #"));
  EXPECT_THAT(fix, HasSubstr("\nuint8 position_covariance_type  #"));
  EXPECT_THAT(fix, HasSubstr("\nint8 status  #"));
  EXPECT_THAT(fix, HasSubstr("\nuint16 service  #"));
}

TEST(MessageDefinitions, EachContainedTypeFollowsOnce) {
  const std::string odometry = message_definition("nav_msgs/msg/Odometry");
  for (const char* type :
       {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion",
        "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist", "geometry_msgs/Vector3"}) {
    const std::string heading = kSeparator + "\nMSG: " + type + '\n';
    const std::size_t at = odometry.find(heading);
    ASSERT_NE(at, std::string::npos) << type;
    EXPECT_EQ(odometry.find(heading, at + 1), std::string::npos) << type << " twice";
    EXPECT_THAT(odometry.substr(at + heading.size()), Not(StartsWith("="))) << type << " is empty";
  }
  EXPECT_THAT(message_definition("tf2_msgs/msg/TFMessage"),
              StartsWith("geometry_msgs/TransformStamped[] transforms\n" + kSeparator));
  const std::string cloud = message_definition("sensor_msgs/msg/PointCloud2");
  EXPECT_THAT(cloud, HasSubstr("\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"));
  EXPECT_THAT(cloud, HasSubstr("\nuint8[] data  #"));
}

TEST(MessageDefinitions, ThereIsOneForAllThatARobotRecords) {
  std::vector<bus::Topic> all = topics::outputs();
  for (const bus::Topic& topic : {topics::points(), topics::imu(), topics::fix(), topics::wheel_odometry(),
                                  topics::battery(), topics::cmd_vel()})
    all.push_back(topic);
  for (const bus::Topic& topic : all) {
    std::string type = topic.type.substr(0, topic.type.size() - 1);
    type.replace(type.find("::msg::dds_::"), 13, "/msg/");
    EXPECT_NE(message_definition(type), "") << type;
  }
  EXPECT_NE(message_definition("velodyne_msgs/msg/VelodyneScan"), "");
  EXPECT_EQ(message_definition("fleetmap/msg/GlobalPose"), "");
  EXPECT_EQ(message_definition(""), "");
}

}  // namespace
}  // namespace fleetmap::ros_codec
