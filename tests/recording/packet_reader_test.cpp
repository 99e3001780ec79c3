// Packets of a Velodyne LiDAR in bags: rosbag2 and ROS 1.
#include "recording/packet_reader.hpp"

#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "bus/captured_log.hpp"
#include "fleetmap/recording/survey.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "pcap_bytes.hpp"
#include "recording/ros1_records.hpp"
#include "ros1_bag.hpp"
#include "support/temporary_folder.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using fleetmap::testing::VelodyneDevice;
using ::testing::HasSubstr;
using namespace recording::testing;

constexpr char kType[] = "velodyne_msgs/msg/VelodyneScan";
constexpr std::int64_t kDelay = 500'000;

/// Messages of a tenth of a second each, as the driver sends them, the first of which begins in mid-turn.
std::vector<ros_codec::VelodyneScan> messages(int count, double azimuth = 100.0) {
  VelodyneDevice device(Duration(kStart), azimuth);
  std::vector<ros_codec::VelodyneScan> all;
  for (int k = 0; k < count; ++k) {
    ros_codec::VelodyneScan& scan = all.emplace_back();
    for (int packets = 0; packets < 76; ++packets) {
      auto packet = device.next();
      scan.packets.push_back({Stamp(packet.fired) + Duration(kDelay), std::move(packet.bytes)});
    }
    scan.stamp = scan.packets.back().received;
  }
  return all;
}

void write(BagWriter& bag, const ros_codec::VelodyneScan& scan, const char* topic = "/velodyne_packets") {
  const auto status = bag.write(topic, kType, scan.stamp, ros_codec::encode(scan));
  ASSERT_TRUE(status) << status.error().message;
}

std::filesystem::path write_velodyne_bag(const TemporaryFolder& folder,
                                         const std::vector<ros_codec::VelodyneScan>& scans) {
  auto bag = BagWriter::create(folder.path() / "b").value();
  for (const auto& scan : scans) write(bag, scan);
  return folder.path() / "b";
}

void expect_turns(const std::vector<Sample>& samples, std::size_t count) {
  ASSERT_EQ(samples.size(), count);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto& scan = std::get<sensor::Scan>(samples[k]);
    // From 100 deg it takes 72 ms to the first turn that begins ahead.
    const double begin = 0.0722 + 0.1 * static_cast<double>(k);
    EXPECT_NEAR(to_seconds(scan.stamp - stamp_from_ns(kStart)), begin, 3e-4);
    EXPECT_NEAR(static_cast<double>(scan.points.size()), 28'935.0, 64.0);
    EXPECT_TRUE(scan.has_time && scan.has_ring);
  }
}

TEST(PacketReader, PacketsInABagAreScans) {
  const TemporaryFolder folder;
  auto reader = open(write_velodyne_bag(folder, messages(5)));
  ASSERT_TRUE(reader) << reader.error().message;
  expect_turns(read_all(**reader), 4);
  const Counters& counters = (*reader)->counters();
  EXPECT_EQ(counters.scans, 4u);
  EXPECT_EQ(counters.incomplete_sweeps, 2u) << "before the first turn and behind the last";
}

TEST(PacketReader, AScanIsRecordedWithThePacketThatCompletesIt) {
  const TemporaryFolder folder;
  auto reader = open(write_velodyne_bag(folder, messages(3)));
  while (true) {
    const auto sample = (*reader)->next();
    ASSERT_TRUE(sample);
    if (!*sample) break;
    const auto recorded = (*reader)->recorded();
    ASSERT_TRUE(recorded);
    const Duration lag = *recorded - stamp_of(**sample);
    EXPECT_GT(lag, Duration::zero());
    EXPECT_LT(lag, std::chrono::milliseconds(250));
  }
  const auto clock = survey(folder.path() / "b");
  ASSERT_TRUE(clock) << clock.error().message;
}

TEST(PacketReader, WithoutPointsOnlyTheStampsAreLeft) {
  const TemporaryFolder folder;
  auto reader = open(write_velodyne_bag(folder, messages(3)), {}, ScanContent::kStampOnly);
  const auto samples = read_all(**reader);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_TRUE(std::get<sensor::Scan>(samples[0]).points.empty());
  EXPECT_NE(to_ns(stamp_of(samples[0])), 0);
}

TEST(PacketReader, PacketsInARos1BagAreScans) {
  std::string bytes(ros1::kMagic);
  bytes += record({{"op", "\x03"}, {"conn_count", u32(0)}}, std::string(100, ' '));
  bytes += connection(0, "/velodyne_packets", "velodyne_msgs/VelodyneScan");
  for (const auto& scan : messages(3)) {
    const auto ns = static_cast<std::uint64_t>(to_ns(scan.stamp));
    std::string data =
        u32(1) + time_of(ns) + counted("velodyne") + u32(static_cast<std::uint32_t>(scan.packets.size()));
    for (const auto& packet : scan.packets)
      data += time_of(static_cast<std::uint64_t>(to_ns(packet.received))) +
              std::string(packet.data.begin(), packet.data.end());
    bytes += message(0, ns, data);
  }
  const TemporaryFolder folder;
  folder.write("a.bag", bytes);
  auto reader = open(folder.path() / "a.bag");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_turns(read_all(**reader), 2);
}

TEST(PacketReader, PacketsInAnMcapFileAreScans) {
  const auto le = [](std::uint64_t value, std::size_t bytes) { return number(value, bytes, false); };
  const auto mcap_record = [&](char opcode, const std::string& content) {
    return std::string(1, opcode) + le(content.size(), 8) + content;
  };
  std::string bytes = "\x89MCAP0\r\n";
  bytes += mcap_record(1, counted("ros2") + counted("test"));
  bytes += mcap_record(3, le(1, 2) + counted(kType) + counted("ros2msg") + counted(""));
  bytes += mcap_record(4, le(7, 2) + le(1, 2) + counted("/velodyne_packets") + counted("cdr") + counted(""));
  for (const auto& scan : messages(3)) {
    const auto ns = static_cast<std::uint64_t>(to_ns(scan.stamp));
    const Bytes cdr = ros_codec::encode(scan);
    bytes +=
        mcap_record(5, le(7, 2) + le(0, 4) + le(ns, 8) + le(ns, 8) + std::string(cdr.begin(), cdr.end()));
  }
  const TemporaryFolder folder;
  folder.write("a.mcap", bytes);
  auto reader = open(folder.path() / "a.mcap");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_turns(read_all(**reader), 2);
}

TEST(PacketReader, CloudsAreTakenWhereABagHasBoth) {
  const TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "b").value();
    for (const auto& scan : messages(2)) write(bag, scan);
    put(bag, ros_codec::topics::points(), kStart, ros_codec::encode(scan_at(kStart)));
  }
  const bus::testing::CapturedLog log;
  auto reader = open(folder.path() / "b");
  EXPECT_THAT(log.text(),
              HasSubstr("the clouds are taken, not /velodyne_packets (velodyne_msgs/msg/VelodyneScan)"));
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(std::get<sensor::Scan>(read_all(**reader).at(0)).points.size(), 20u);

  ReaderConfig packets;
  packets.topics.points = "/velodyne_packets";
  reader = open(folder.path() / "b", packets);
  ASSERT_TRUE(reader) << reader.error().message;
  expect_turns(read_all(**reader), 1);
}

TEST(PacketReader, SeveralDevicesNeedAChoice) {
  const TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "b").value();
    for (const char* topic : {"/left/packets", "/right/packets"}) write(bag, messages(1)[0], topic);
  }
  EXPECT_THAT(refusal(folder.path() / "b"), HasSubstr("choose one with recording.topics.points"));
}

TEST(PacketReader, RefusedPacketsAreCountedByReason) {
  const TemporaryFolder folder;
  auto scans = messages(3);
  scans[1].packets[3].data[0] = 0;        // flag
  scans[1].packets[4].data[1205] = 0xa1;  // product
  scans[1].packets[5].data[1204] = 0;     // return mode
  auto reader = open(write_velodyne_bag(folder, scans));
  EXPECT_EQ(read_all(**reader).size(), 2u) << "a scan with a hole is a scan";
  const Counters& counters = (*reader)->counters();
  EXPECT_EQ(counters.packets_of_wrong_blocks, 1u);
  EXPECT_EQ(counters.packets_of_unknown_device, 2u);
  EXPECT_EQ(counters.packets_of_wrong_size, 0u);
}

TEST(PacketReader, PacketsWithoutAStampTakeTheTimeOfRecording) {
  const TemporaryFolder folder;
  auto scans = messages(4);
  for (auto& scan : scans) {
    for (auto& packet : scan.packets) packet.received = Stamp();
  }
  auto reader = open(write_velodyne_bag(folder, scans));
  const auto samples = read_all(**reader);
  expect_turns(samples, 3);
  EXPECT_EQ((*reader)->counters().unstamped_messages, 4u * 76u);
}

TEST(PacketReader, AMessageOfOtherBytesIsCounted) {
  const TemporaryFolder folder;
  {
    auto bag = BagWriter::create(folder.path() / "b").value();
    for (const auto& scan : messages(3)) write(bag, scan);
    ASSERT_TRUE(bag.write("/velodyne_packets", kType, stamp_from_ns(kStart + 1), Bytes(10)));
  }
  auto reader = open(folder.path() / "b");
  EXPECT_EQ(read_all(**reader).size(), 2u);
  EXPECT_EQ((*reader)->counters().undecodable_messages, 1u);
}

}  // namespace
}  // namespace fleetmap::recording
