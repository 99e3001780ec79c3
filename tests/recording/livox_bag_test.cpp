// Messages of a Livox driver in bags: rosbag2 (SQLite and mcap) and ROS 1.
#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "bus/captured_log.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "pcap_bytes.hpp"
#include "recording/ros1_records.hpp"
#include "ros1_bag.hpp"
#include "support/livox_message.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::LivoxMessage;
using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace recording::testing;

constexpr std::array kTypes{"livox_ros_driver2/msg/CustomMsg", "livox_ros_driver/msg/CustomMsg",
                            "livox_interfaces/msg/CustomMsg"};

/// Ten points, the fourth of which is noise.
LivoxMessage message_at(std::int64_t ns) {
  LivoxMessage message{.stamp = static_cast<std::uint64_t>(ns), .timebase = static_cast<std::uint64_t>(ns)};
  for (std::uint8_t k = 0; k < 10; ++k)
    message.points.push_back({.offset_time = k * 10'000'000u,
                              .x = 1.0f + k,
                              .tag = k == 3 ? std::uint8_t{1} : std::uint8_t{0x10},
                              .line = k});
  return message;
}

std::int64_t time_of_message(int k) { return kStart + std::int64_t{k} * 100'000'000; }

void expect_scans(Reader& reader, std::size_t count) {
  const auto samples = read_all(reader);
  ASSERT_EQ(samples.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& scan = std::get<sensor::Scan>(samples[k]);
    EXPECT_EQ(to_ns(scan.stamp), time_of_message(static_cast<int>(k)));
    ASSERT_EQ(scan.points.size(), 9u);
    EXPECT_FLOAT_EQ(scan.points.back().time, 0.09f);
    EXPECT_EQ(scan.points.back().ring, 9);
    EXPECT_EQ(scan.points.back().position, Eigen::Vector3f(10.0f, 2.0f, 3.0f));
  }
  EXPECT_EQ(reader.counters().noise_points, count);
}

TEST(LivoxBag, OfRosbag2IsRead) {
  for (const char* type : kTypes) {
    const TemporaryFolder folder;
    {
      auto bag = BagWriter::create(folder.path() / "b").value();
      for (int k = 0; k < 3; ++k)
        ASSERT_TRUE(bag.write("/livox/lidar", type, stamp_from_ns(time_of_message(k)),
                              message_at(time_of_message(k)).cdr()));
    }
    auto reader = open(folder.path() / "b");
    ASSERT_TRUE(reader) << reader.error().message;
    expect_scans(**reader, 3);
    EXPECT_EQ((*reader)->frames().ids[0], "livox_frame");
  }
}

TEST(LivoxBag, OfMcapIsRead) {
  const auto le = [](std::uint64_t value, std::size_t bytes) { return number(value, bytes, false); };
  const auto mcap_record = [&](char opcode, const std::string& content) {
    return std::string(1, opcode) + le(content.size(), 8) + content;
  };
  std::string bytes = "\x89MCAP0\r\n";
  bytes += mcap_record(1, counted("ros2") + counted("test"));
  bytes += mcap_record(3, le(1, 2) + counted(kTypes[0]) + counted("ros2msg") + counted(""));
  bytes += mcap_record(4, le(7, 2) + le(1, 2) + counted("/livox/lidar") + counted("cdr") + counted(""));
  for (int k = 0; k < 3; ++k) {
    const auto ns = static_cast<std::uint64_t>(time_of_message(k));
    const Bytes cdr = message_at(time_of_message(k)).cdr();
    bytes +=
        mcap_record(5, le(7, 2) + le(0, 4) + le(ns, 8) + le(ns, 8) + std::string(cdr.begin(), cdr.end()));
  }
  const TemporaryFolder folder;
  folder.write("a.mcap", bytes);
  auto reader = open(folder.path() / "a.mcap");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_scans(**reader, 3);
}

TEST(LivoxBag, OfRos1IsRead) {
  std::string bytes(ros1::kMagic);
  bytes += record({{"op", "\x03"}, {"conn_count", u32(0)}}, std::string(100, ' '));
  bytes += connection(0, "/livox/lidar", "livox_ros_driver/CustomMsg");
  for (int k = 0; k < 3; ++k) {
    const Bytes data = message_at(time_of_message(k)).ros1();
    bytes +=
        message(0, static_cast<std::uint64_t>(time_of_message(k)), std::string(data.begin(), data.end()));
  }
  const TemporaryFolder folder;
  folder.write("a.bag", bytes);
  auto reader = open(folder.path() / "a.bag");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_scans(**reader, 3);
}

TEST(LivoxBag, MessagesThatAreCutAreCounted) {
  const TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "b").value();
    for (int k = 0; k < 4; ++k) {
      Bytes cdr = message_at(time_of_message(k)).cdr();
      if (k == 3) cdr.resize(cdr.size() - 7);
      ASSERT_TRUE(bag.write("/livox/lidar", kTypes[0], stamp_from_ns(time_of_message(k)), cdr));
    }
  }
  auto reader = open(folder.path() / "b");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_scans(**reader, 3);
  EXPECT_EQ((*reader)->counters().undecodable_messages, 1u);
}

TEST(LivoxBag, CloudsAreTakenFirstAndPacketsLast) {
  const TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "b").value();
    ASSERT_TRUE(bag.write("/livox/lidar", kTypes[0], stamp_from_ns(kStart), message_at(kStart).cdr()));
    ASSERT_TRUE(bag.write("/velodyne_packets", "velodyne_msgs/msg/VelodyneScan", stamp_from_ns(kStart),
                          ros_codec::encode(ros_codec::VelodyneScan{stamp_from_ns(kStart), {}})));
  }
  {
    const bus::testing::CapturedLog log;
    auto reader = open(folder.path() / "b");
    ASSERT_TRUE(reader) << reader.error().message;
    expect_scans(**reader, 1);
    EXPECT_THAT(log.text(), HasSubstr("not /velodyne_packets (velodyne_msgs/msg/VelodyneScan)"));
  }
  {
    auto bag = BagWriter::create(folder.path() / "c").value();
    ASSERT_TRUE(bag.write("/livox/lidar", kTypes[0], stamp_from_ns(kStart), message_at(kStart).cdr()));
    put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
  }
  auto reader = open(folder.path() / "c");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(std::get<sensor::Scan>(read_all(**reader).at(0)).points.size(), 20u) << "the cloud";
  ReaderConfig livox;
  livox.topics.points = "/livox/lidar";
  reader = open(folder.path() / "c", livox);
  ASSERT_TRUE(reader) << reader.error().message;
  expect_scans(**reader, 1);
}

}  // namespace
}  // namespace fleetmap::recording
