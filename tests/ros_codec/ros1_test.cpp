#include "fleetmap/ros_codec/ros1.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <string>

#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "support/livox_message.hpp"

namespace fleetmap::ros_codec {
namespace {

using ::testing::HasSubstr;

/// Writes fields as genmsg's serialisers of ROS 1 do: little-endian, nothing between them.
class Ros1Message {
 public:
  template <std::unsigned_integral T>
  Ros1Message& put(T value) {
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
    return *this;
  }
  Ros1Message& put(double value) { return put(std::bit_cast<std::uint64_t>(value)); }
  Ros1Message& put(float value) { return put(std::bit_cast<std::uint32_t>(value)); }
  Ros1Message& put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  Ros1Message& zeros(int count) {
    for (int k = 0; k < count; ++k) put(0.0);
    return *this;
  }
  /// A header of 5.25 s whose frame is as long as it pleases, so that alignment shows.
  Ros1Message& header(const std::string& frame) {
    return put(std::uint32_t{77}).put(std::uint32_t{5}).put(std::uint32_t{250'000'000}).put(frame);
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

constexpr char kImu[] = "sensor_msgs/msg/Imu";

Bytes imu(const std::string& frame) {
  Ros1Message message;
  message.header(frame).put(0.0).put(0.0).put(0.0).put(1.0).zeros(9);
  message.put(0.1).put(0.2).put(0.3).zeros(9);
  return message.put(1.0).put(2.0).put(9.5).zeros(9).bytes();
}

TEST(Ros1, ImuOfAnyFrameName) {
  for (const char* frame : {"", "a", "imu", "imu_link", "a/long/name/of/a/frame"}) {
    const auto cdr = cdr_from_ros1(kImu, imu(frame));
    ASSERT_TRUE(cdr) << cdr.error().message;
    const auto decoded = decode<sensor::Imu>(*cdr);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(to_ns(decoded->stamp), 5'250'000'000);
    EXPECT_EQ(decoded->angular_velocity, Eigen::Vector3d(0.1, 0.2, 0.3));
    EXPECT_EQ(decoded->specific_force, Eigen::Vector3d(1.0, 2.0, 9.5));
  }
}

TEST(Ros1, NavSatFix) {
  Ros1Message message;
  message.header("gps").put(std::uint8_t{0}).put(std::uint16_t{1}).put(49.5).put(8.25).put(110.0);
  message.put(4.0).zeros(3).put(4.0).zeros(3).put(9.0).put(std::uint8_t{2});
  const auto cdr = cdr_from_ros1("sensor_msgs/msg/NavSatFix", message.bytes());
  ASSERT_TRUE(cdr) << cdr.error().message;
  const auto fix = decode<sensor::Fix>(*cdr);
  ASSERT_TRUE(fix) << fix.error().message;
  EXPECT_TRUE(fix->valid);
  EXPECT_NEAR(fix->position.latitude, geo_point_from_degrees(49.5, 8.25, 110.0).latitude, 1e-15);
  EXPECT_EQ(fix->position.altitude, 110.0);
}

TEST(Ros1, Odometry) {
  Ros1Message message;
  message.header("odom").put(std::string("base_link")).put(3.0).zeros(5).put(1.0).zeros(36);
  message.put(1.5).zeros(4).put(-0.25).zeros(36);
  const auto cdr = cdr_from_ros1("nav_msgs/msg/Odometry", message.bytes());
  ASSERT_TRUE(cdr) << cdr.error().message;
  const auto wheel = decode<sensor::Wheel>(*cdr);
  ASSERT_TRUE(wheel) << wheel.error().message;
  EXPECT_EQ(wheel->forward_speed, 1.5);
  EXPECT_EQ(wheel->yaw_rate, -0.25);
}

TEST(Ros1, PointCloud2WithFieldNamesOfOddLengths) {
  Ros1Message message;
  message.header("velodyne").put(std::uint32_t{1}).put(std::uint32_t{2}).put(std::uint32_t{4});
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    message.put(std::string(name)).put(offset).put(std::uint8_t{7}).put(std::uint32_t{1});
    offset += 4;
  }
  message.put(std::uint8_t{0}).put(std::uint32_t{16}).put(std::uint32_t{32}).put(std::uint32_t{32});
  for (const float value : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f, 8.0f}) message.put(value);
  message.put(std::uint8_t{1});
  const auto cdr = cdr_from_ros1("sensor_msgs/msg/PointCloud2", message.bytes());
  ASSERT_TRUE(cdr) << cdr.error().message;
  const auto decoded = decode_scan(*cdr);
  ASSERT_TRUE(decoded) << decoded.error().message;
  ASSERT_EQ(decoded->scan.points.size(), 2u);
  EXPECT_EQ(decoded->scan.points[1].position, Eigen::Vector3f(5.0f, 6.0f, 7.0f));
  EXPECT_EQ(decoded->scan.points[1].intensity, 8.0f);
}

TEST(Ros1, VelodyneScanWhosePacketsAreNoMultipleOfFourBytes) {
  for (const char* frame : {"", "velodyne", "front"}) {
    Ros1Message message;
    message.header(frame).put(std::uint32_t{3});
    for (std::uint32_t k = 0; k < 3; ++k) {
      message.put(6 + k).put(std::uint32_t{500});
      for (int byte = 0; byte < 1206; ++byte)
        message.put(static_cast<std::uint8_t>(byte + static_cast<int>(k)));
    }
    const auto cdr = cdr_from_ros1("velodyne_msgs/msg/VelodyneScan", message.bytes());
    ASSERT_TRUE(cdr) << cdr.error().message;
    const auto scan = decode_velodyne_scan(*cdr);
    ASSERT_TRUE(scan) << scan.error().message;
    EXPECT_EQ(to_ns(scan->stamp), 5'250'000'000);
    ASSERT_EQ(scan->packets.size(), 3u);
    EXPECT_EQ(to_ns(scan->packets[2].received), 8'000'000'500);
    EXPECT_EQ(scan->packets[2].data.front(), 2);
    EXPECT_EQ(scan->packets[2].data.back(), static_cast<std::uint8_t>(1207));
  }
}

TEST(Ros1, LivoxPointsWhoseNineteenBytesAreNoMultipleOfFour) {
  for (const char* frame : {"", "a", "livox_frame"}) {
    fleetmap::testing::LivoxMessage message{
        .stamp = 5'250'000'000, .timebase = 5'250'000'000, .frame = frame};
    for (std::uint8_t k = 0; k < 5; ++k)
      message.points.push_back({.offset_time = k * 1'000'000u, .x = 0.5f + k, .reflectivity = k, .line = k});
    for (const char* type : {"livox_ros_driver/msg/CustomMsg", "livox_ros_driver2/msg/CustomMsg"}) {
      const auto cdr = cdr_from_ros1(type, message.ros1());
      ASSERT_TRUE(cdr) << cdr.error().message;
      EXPECT_EQ(*cdr, message.cdr());
    }
  }
}

TEST(Ros1, TfMessageWithNamesOfAnyLength) {
  for (const char* child : {"imu", "velodyne", "os_lidar"}) {
    Ros1Message message;
    message.put(std::uint32_t{2});
    for (double x : {1.0, 2.0}) {
      message.header("base_link").put(std::string(child)).put(x).zeros(2);
      message.put(0.5).put(-0.5).put(0.5).put(0.5);
    }
    const auto cdr = cdr_from_ros1("tf2_msgs/msg/TFMessage", message.bytes());
    ASSERT_TRUE(cdr) << cdr.error().message;
    const auto transforms = decode_transforms(*cdr);
    ASSERT_TRUE(transforms) << transforms.error().message;
    ASSERT_EQ(transforms->size(), 2u);
    EXPECT_EQ(transforms->back().parent, "base_link");
    EXPECT_EQ(transforms->back().child, child);
    EXPECT_EQ(transforms->back().translation, Eigen::Vector3d(2.0, 0.0, 0.0));
    EXPECT_EQ(transforms->back().rotation.coeffs(), Eigen::Vector4d(0.5, -0.5, 0.5, 0.5)) << "x, y, z, w";
  }
}

TEST(Ros1, InvalidMessagesAreRefused) {
  const Bytes whole = imu("imu");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(cdr_from_ros1(kImu, ByteView(whole).first(size))) << size;
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(cdr_from_ros1(kImu, longer));
  EXPECT_THAT(cdr_from_ros1("std_msgs/msg/String", whole).error().message,
              HasSubstr("is not read from ROS 1"));
  Bytes many = whole;
  std::fill(many.begin() + 12, many.end(), 0xff);
  EXPECT_FALSE(cdr_from_ros1("sensor_msgs/msg/PointCloud2", many)) << "4 billion fields";
  EXPECT_FALSE(cdr_from_ros1("tf2_msgs/msg/TFMessage", many)) << "4 billion transforms";
  EXPECT_FALSE(cdr_from_ros1("velodyne_msgs/msg/VelodyneScan", many)) << "4 billion packets";
  EXPECT_FALSE(cdr_from_ros1("livox_ros_driver/msg/CustomMsg", many)) << "4 billion points";
}

}  // namespace
}  // namespace fleetmap::ros_codec
