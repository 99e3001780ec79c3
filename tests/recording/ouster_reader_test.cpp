#include "ouster_reader.hpp"

#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "pcap_bytes.hpp"
#include "support/ouster_packets.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::OusterDevice;
using fleetmap::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace recording::testing;

/// Four turns and a half of a device at 10 Hz whose clock counts from its start, with 100 Hz of its IMU, one
/// packet of a second device and one of another size; all in fragments.
std::string capture() {
  OusterDevice device{Duration(140'000'000'000)};
  std::string bytes = pcap_header();
  const auto put = [&](Stamp captured, const UdpFrame& to, const Bytes& payload) {
    for (const std::string& frame : udp_fragments(to, payload)) bytes += pcap_record(captured, frame);
  };
  for (int k = 0; k < 288; ++k) {
    const auto packet = device.next();
    const Stamp sent = stamp_from_ns(kStart) + (packet.sent - Duration(140'000'000'000));
    put(sent + std::chrono::microseconds(300), {.port = 7502}, packet.bytes);
    if (k % 6 == 0)
      put(sent + std::chrono::microseconds(900), {.port = 7503},
          OusterDevice::imu(packet.sent, {0, 0, 1}, {0, 0, 90}));
    if (k == 20) put(sent, {.source = 0x0a000001, .port = 7502}, packet.bytes);
    if (k == 30) put(sent, {.port = 7502}, Bytes(100));
    if (k == 40) put(sent, {.port = 9000}, Bytes(2'000));
  }
  return bytes;
}

void expect_ouster_drive(Reader& reader) {
  std::size_t scans = 0, imus = 0;
  for (const Sample& sample : read_all(reader)) {
    if (const auto* scan = std::get_if<sensor::Scan>(&sample)) {
      EXPECT_NEAR(to_seconds(scan->stamp - stamp_from_ns(kStart)), 0.1 * static_cast<double>(scans++) + 3e-4,
                  5e-6);
      EXPECT_EQ(scan->points.size(), 1024u * 16u);
      EXPECT_TRUE(scan->has_time && scan->has_ring);
    } else {
      const auto& imu = std::get<sensor::Imu>(sample);
      ++imus;
      EXPECT_NEAR(imu.specific_force.z(), 9.80665, 1e-6);
      EXPECT_NEAR(imu.angular_velocity.z(), 1.570796, 1e-6);
    }
  }
  EXPECT_EQ(scans, 4u);
  EXPECT_EQ(imus, 48u);
  EXPECT_EQ(reader.counters().packets_of_other_devices, 1u);
  EXPECT_EQ(reader.counters().packets_of_wrong_size, 1u);
  EXPECT_EQ(reader.counters().incomplete_sweeps, 1u);
  EXPECT_EQ(reader.counters().damaged_parts, 0u);
}

TEST(OusterReader, ReadsScansAndImuByTheMetadataBesideTheCapture) {
  const TemporaryFolder folder;
  folder.write("drive.pcap", capture());
  folder.write("drive.json", OusterDevice(Duration::zero()).metadata());
  auto reader = open(folder.path() / "drive.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  expect_ouster_drive(**reader);
}

TEST(OusterReader, ReadsByTheMetadataOfTheConfiguration) {
  const TemporaryFolder folder;
  folder.write("drive.pcap", capture());
  ReaderConfig config;
  config.ouster_metadata =
      sensor::read_ouster_metadata(OusterDevice(Duration::zero()).metadata(true)).value();
  auto reader = open(folder.path() / "drive.pcap", config);
  ASSERT_TRUE(reader) << reader.error().message;
  expect_ouster_drive(**reader);
}

TEST(OusterReader, WithoutPointsOnlyTheStampsAreLeft) {
  const TemporaryFolder folder;
  folder.write("drive.pcap", capture());
  const auto metadata = sensor::read_ouster_metadata(OusterDevice(Duration::zero()).metadata()).value();
  auto reader = open_ouster_capture(folder.path() / "drive.pcap", metadata, ScanContent::kStampOnly);
  ASSERT_TRUE(reader);
  std::size_t scans = 0;
  for (const Sample& sample : read_all(**reader)) {
    const auto* scan = std::get_if<sensor::Scan>(&sample);
    scans += scan != nullptr;
    EXPECT_TRUE(scan == nullptr || scan->points.empty());
  }
  EXPECT_EQ(scans, 4u);
}

TEST(OusterReader, ErrorsSayWhatIsMissing) {
  const TemporaryFolder folder;
  folder.write("drive.pcap", capture());
  EXPECT_THAT(refusal(folder.path() / "drive.pcap"),
              AllOf(HasSubstr("for an Ouster LiDAR name its metadata (lidar.ouster_metadata)"),
                    HasSubstr("drive.json")));
  OusterDevice other(Duration::zero());
  other.profile = "RNG15_RFL8_NIR8";
  folder.write("drive.json", other.metadata());
  EXPECT_THAT(refusal(folder.path() / "drive.pcap"),
              AllOf(HasSubstr("no packet of 1280 bytes, as the metadata of OS-1-16 122 (RNG15_RFL8_NIR8)"),
                    HasSubstr("are the metadata those of this capture?")));
  // `tcpdump udp port 7502` captures the first fragment of each packet alone.
  std::string first_fragments = pcap_header();
  for (int k = 0; k < 10; ++k)
    first_fragments += pcap_record(stamp_from_ns(kStart), udp_fragments({.port = 7502}, Bytes(3'392))[0]);
  folder.write("drive.pcap", first_fragments);
  folder.write("drive.json", OusterDevice(Duration::zero()).metadata());
  EXPECT_THAT(refusal(folder.path() / "drive.pcap"), HasSubstr("filtered by host, not by port"));
}

TEST(OusterReader, ACaptureThatIsCutIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  const std::string whole = capture();
  folder.write("drive.pcap", whole.substr(0, whole.size() / 2));
  folder.write("drive.json", OusterDevice(Duration::zero()).metadata());
  auto reader = open(folder.path() / "drive.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_GT(read_all(**reader).size(), 20u);
  EXPECT_EQ((*reader)->counters().scans, 2u);
  EXPECT_GE((*reader)->counters().damaged_parts, 1u);
}

}  // namespace
}  // namespace fleetmap::recording
