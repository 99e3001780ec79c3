#include "fleetmap/ros_codec/points_type.hpp"

#include <gmock/gmock.h>

namespace fleetmap::ros_codec {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(PointsType, HasTheNamesOfRos2) {
  EXPECT_EQ(ros_name(PointsType::kPointCloud2), "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(dds_name(PointsType::kPointCloud2), "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_EQ(ros_name(PointsType::kLivoxDriver2), "livox_ros_driver2/msg/CustomMsg");
  EXPECT_EQ(dds_name(PointsType::kLivoxDriver2), "livox_ros_driver2::msg::dds_::CustomMsg_");
  for (const PointsType type : kPointsTypes) EXPECT_EQ(points_type(ros_name(type)), type);
}

TEST(PointsType, AnErrorListsThoseThatExist) {
  EXPECT_THAT(
      points_type("sensor_msgs/msg/LaserScan").error().message,
      AllOf(HasSubstr("LaserScan"), HasSubstr("sensor_msgs/msg/PointCloud2"),
            HasSubstr("livox_ros_driver2/msg/CustomMsg"), HasSubstr("livox_interfaces/msg/CustomMsg")));
}

TEST(PointsType, AScanComesBackInEachAndInNoOther) {
  sensor::Scan scan;
  scan.stamp = stamp_from_ns(1'700'000'000'000'000'000);
  scan.has_time = scan.has_ring = true;
  for (int k = 0; k < 50; ++k)
    scan.points.push_back({{1.0f, 2.0f, 3.0f}, 4.0f, 0.001f * static_cast<float>(k), 2});
  for (const PointsType type : kPointsTypes) {
    const Bytes cdr = encode_points(scan, type);
    const auto back = decode_points(cdr, type);
    ASSERT_TRUE(back) << ros_name(type) << back.error().message;
    EXPECT_EQ(back->scan.points.size(), 50u);
    EXPECT_NEAR(back->scan.points[49].time, 0.049f, 1e-6);
    const bool livox = type != PointsType::kPointCloud2;
    EXPECT_FALSE(decode_points(cdr, livox ? PointsType::kPointCloud2 : PointsType::kLivoxDriver2));
    EXPECT_EQ(stamp_of_points(cdr, type), scan.stamp);
  }
}

TEST(PointsType, AMessageThatEndsWithinItsStampIsRefusedUnderItsOwnType) {
  for (const PointsType type : kPointsTypes) {
    Bytes cdr = encode_points(sensor::Scan{}, type);
    for (const std::size_t size : {11, 8, 3, 0}) {
      cdr.resize(size);
      const auto stamp = stamp_of_points(cdr, type);
      ASSERT_FALSE(stamp) << size;
      EXPECT_THAT(stamp.error().message, StartsWith(dds_name(type)));
    }
    cdr = encode_points(sensor::Scan{}, type);
    cdr[11] = 0xff;  // of the nanoseconds' uint32: more than a second
    EXPECT_THAT(stamp_of_points(cdr, type).error().message,
                AllOf(StartsWith(dds_name(type)), HasSubstr("is not a time")));
  }
}

}  // namespace
}  // namespace fleetmap::ros_codec
