#include "devices/ouster_input.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <mutex>
#include <vector>

#include "apps/devices/patience.hpp"
#include "fleetmap/core/utc.hpp"
#include "support/eventually.hpp"
#include "support/ouster_packets.hpp"
#include "support/udp_sender.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::eventually;
using fleetmap::testing::free_udp_port;
using fleetmap::testing::OusterDevice;
using fleetmap::testing::UdpSender;
using ::testing::HasSubstr;

agent::OusterConfig config_of(const OusterDevice& device) {
  agent::OusterConfig config;
  config.metadata = sensor::read_ouster_metadata(device.metadata()).value();
  config.lidar_port = free_udp_port();
  do config.imu_port = free_udp_port();
  while (config.imu_port == config.lidar_port);
  return config;
}

/// An input whose samples are collected.
struct ReceivedOuster {
  std::mutex mutex;
  std::vector<sensor::Scan> scans;
  std::vector<sensor::Imu> imus;
  std::unique_ptr<OusterInput> input;

  explicit ReceivedOuster(const agent::OusterConfig& config) {
    auto opened = OusterInput::open(config, {.on_scan =
                                                 [this](const sensor::Scan& scan) {
                                                   const std::scoped_lock lock(mutex);
                                                   scans.push_back(scan);
                                                 },
                                             .on_imu =
                                                 [this](const sensor::Imu& imu) {
                                                   const std::scoped_lock lock(mutex);
                                                   imus.push_back(imu);
                                                 }});
    EXPECT_TRUE(opened) << opened.error().message;
    if (opened) input = std::move(*opened);
  }
  void wait_for(std::uint64_t packets, std::uint64_t imu_packets) {
    EXPECT_TRUE(eventually(
        [&] {
          const OusterInput::Counters counters = input->counters();
          return counters.lidar.datagrams >= packets && counters.imu.datagrams >= imu_packets;
        },
        kPatience));
  }
};

TEST(OusterInput, PacketsOverUdpBecomeScansAndImuSamples) {
  for (const char* profile : {"LEGACY", "RNG15_RFL8_NIR8", "RNG19_RFL8_SIG16_NIR16_DUAL"}) {
    const Stamp start = system_now();
    OusterDevice device(start.time_since_epoch());
    device.profile = profile;
    const agent::OusterConfig config = config_of(device);
    ReceivedOuster received(config);
    const UdpSender lidar(config.lidar_port), imu(config.imu_port);
    std::uint64_t imu_packets = 0;
    for (std::uint64_t sent = 1; sent <= 200; ++sent) {
      const auto packet = device.next();
      lidar.send(packet.bytes);
      if (sent % 20 == 0)
        imu.send(OusterDevice::imu(packet.sent, {0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 90.0f})), ++imu_packets;
      if (sent % 10 == 0)
        received.wait_for(sent, imu_packets);  // so that the system's buffer does not run over
    }
    const OusterInput::Counters counters = received.input->counters();
    EXPECT_EQ(counters.lidar.refused + counters.imu.refused, 0u) << profile;
    EXPECT_EQ(counters.scans, 3u);
    EXPECT_EQ(counters.imus, 10u);
    received.input.reset();
    ASSERT_EQ(received.scans.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(to_seconds(received.scans[k].stamp - start), 0.1 * static_cast<double>(k), 1e-6);
      EXPECT_EQ(received.scans[k].points.size(), 1024u * 16u);
    }
    ASSERT_EQ(received.imus.size(), 10u);
    EXPECT_NEAR(received.imus[0].specific_force.z(), 9.80665, 1e-6);
    EXPECT_NEAR(received.imus[0].angular_velocity.z(), 1.570796, 1e-6);
  }
}

TEST(OusterInput, BytesThatAreNoPacketAreCounted) {
  const agent::OusterConfig config = config_of(OusterDevice(Duration::zero()));
  ReceivedOuster received(config);
  const UdpSender lidar(config.lidar_port), imu(config.imu_port);
  for (const std::size_t size : {0u, 48u, 3'000u}) lidar.send(Bytes(size));
  imu.send(Bytes(100));
  received.wait_for(3, 1);
  EXPECT_EQ(received.input->counters().lidar.refused, 3u);
  EXPECT_EQ(received.input->counters().imu.refused, 1u);
}

TEST(OusterInput, APortThatIsTakenIsNamedByItsKey) {
  agent::OusterConfig config = config_of(OusterDevice(Duration::zero()));
  ReceivedOuster received(config);
  EXPECT_THAT(OusterInput::open(config, {}).error().message, HasSubstr("lidar.ouster_port"));
  config.lidar_port = free_udp_port();
  EXPECT_THAT(OusterInput::open(config, {}).error().message,
              HasSubstr("lidar.ouster_imu_port " + std::to_string(config.imu_port)));
}

}  // namespace
}  // namespace fleetmap::apps
