#include "recordings/sample_player.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/ros_codec/samples.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(SamplePlayer, EachSampleGoesToTheTopicOfItsKind) {
  agent::SensorTopics names;
  names.imu = "/my/imu";
  names.fix = "/my/fix";
  sensor::Imu imu;
  imu.stamp = stamp_from_ns(7);
  imu.angular_velocity = {0.1, 0.2, 0.3};
  const EncodedSample turn = encode(recording::Sample(imu), names);
  EXPECT_EQ(turn.topic.name, "/my/imu");
  const auto decoded = ros_codec::decode<sensor::Imu>(turn.cdr);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->stamp, imu.stamp);
  EXPECT_EQ(decoded->angular_velocity, imu.angular_velocity);
  EXPECT_EQ(encode(recording::Sample(sensor::Fix{}), names).topic.name, "/my/fix");
  EXPECT_EQ(encode(recording::Sample(sensor::Wheel{}), names).topic.name, names.wheel);
}

TEST(SamplePlayer, AScanIsOfTheTypeThatTheRobotHears) {
  agent::SensorTopics names;
  EXPECT_EQ(encode(recording::Sample(sensor::Scan{}), names).topic.type,
            "sensor_msgs::msg::dds_::PointCloud2_");
  names.points_type = ros_codec::PointsType::kLivoxDriver;
  sensor::Scan scan;
  scan.stamp = stamp_from_ns(7);
  scan.points.push_back({{1.0f, 2.0f, 3.0f}});
  const EncodedSample livox = encode(recording::Sample(scan), names);
  EXPECT_EQ(livox.topic.type, "livox_ros_driver::msg::dds_::CustomMsg_");
  const auto decoded = ros_codec::decode_points(livox.cdr, names.points_type);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->scan.points.size(), 1u);
}

TEST(SamplePlayer, MountsAreNamedByTheFramesOfThePlayedMessages) {
  sensor::SensorFrames frames;
  EXPECT_THAT(mounts_of(frames), IsEmpty());
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  frames.add({{"base_link", "mast", {0.0, 0.0, 1.0}, Eigen::Quaterniond::Identity()},
              {"mast", "velodyne", {0.2, 0.0, 0.0}, turned}});
  frames.ids = {"velodyne", "imu_link", "", ""};
  const auto mounts = mounts_of(frames);
  ASSERT_THAT(mounts, SizeIs(1)) << "of the IMU's frame nothing is known, GPS names none";
  EXPECT_EQ(mounts[0].parent, "base_link");
  EXPECT_EQ(mounts[0].child, "lidar");
  EXPECT_LT((mounts[0].translation - Eigen::Vector3d(0.2, 0.0, 1.0)).norm(), 1e-12);
  EXPECT_LT(mounts[0].rotation.angularDistance(turned), 1e-12);
}

}  // namespace
}  // namespace fleetmap::apps
