#include "recording/pcap_reader.hpp"

#include <gmock/gmock.h>

#include "bag_samples.hpp"
#include "pcap_bytes.hpp"
#include "support/temporary_folder.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using fleetmap::testing::VelodyneDevice;
using ::testing::HasSubstr;
using namespace recording::testing;

/// Four tenths of a second of a device, with one position packet and one of a second device.
std::string velodyne_capture() {
  VelodyneDevice device{Duration(kStart)};
  std::string bytes = pcap_header();
  for (int k = 0; k < 310; ++k) {
    const auto packet = device.next();
    const Stamp captured = Stamp(packet.fired) + std::chrono::microseconds(300);
    bytes += pcap_record(captured, udp_frame({}, packet.bytes));
    if (k == 100) bytes += pcap_record(captured, udp_frame({.port = 8308}, Bytes(512)));
    if (k == 200) bytes += pcap_record(captured, udp_frame({.source = 0x0a000001}, packet.bytes));
    if (k == 250) bytes += pcap_record(captured, udp_frame({}, Bytes(100)));
  }
  return bytes;
}

TEST(PcapReader, PacketsOfOneDeviceAreScans) {
  const TemporaryFolder folder;
  folder.write("drive.pcap", velodyne_capture());
  auto reader = open(folder.path() / "drive.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  std::size_t scans = 0;
  while (true) {
    const auto sample = (*reader)->next();
    ASSERT_TRUE(sample) << sample.error().message;
    if (!*sample) break;
    EXPECT_NEAR(to_seconds(stamp_of(**sample) - stamp_from_ns(kStart)), 0.1 * static_cast<double>(scans++),
                2e-4);
    ASSERT_TRUE((*reader)->recorded());
    EXPECT_NEAR(to_seconds(*(*reader)->recorded() - stamp_of(**sample)), 0.1, 3e-3);
  }
  EXPECT_EQ(scans, 4u);
  const Counters& counters = (*reader)->counters();
  EXPECT_EQ(counters.packets_of_other_devices, 1u);
  EXPECT_EQ(counters.packets_of_wrong_size, 1u);
  EXPECT_EQ(counters.incomplete_sweeps, 1u);
}

TEST(PcapReader, ACaptureThatIsCutIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  const std::string whole = velodyne_capture();
  folder.write("drive.pcap", whole.substr(0, whole.size() / 2));
  auto reader = open(folder.path() / "drive.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(read_all(**reader).size(), 2u);
  EXPECT_EQ((*reader)->counters().damaged_parts, 1u);
}

TEST(PcapReader, WithoutADataPacketTheReasonIsNamed) {
  const TemporaryFolder folder;
  folder.write("a.pcap", pcap_header() + pcap_record(stamp_from_ns(kStart), udp_frame({}, Bytes(512))));
  EXPECT_THAT(refusal(folder.path() / "a.pcap"),
              HasSubstr("no data packet of a Velodyne LiDAR (1206 bytes over UDP) among 1 frames"));
  folder.write("b.pcap", pcap_header() + pcap_record(stamp_from_ns(kStart), udp_frame({}, Bytes(1206))));
  EXPECT_THAT(refusal(folder.path() / "b.pcap"), HasSubstr("one of its size is refused: product id 0x00"));
  folder.write("c.pcapng", std::string("\x0a\x0d\x0d\x0a") + std::string(30, '\0'));
  EXPECT_THAT(refusal(folder.path() / "c.pcapng"), HasSubstr("pcapng is not read here"));
}

}  // namespace
}  // namespace fleetmap::recording
