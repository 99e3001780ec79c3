#include "devices/velodyne_input.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "apps/devices/patience.hpp"
#include "fleetmap/core/utc.hpp"
#include "support/eventually.hpp"
#include "support/udp_sender.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::UdpSender;
using fleetmap::testing::VelodyneDevice;
using ::testing::HasSubstr;

/// An input whose scans are collected.
struct ReceivedVelodyne {
  std::mutex mutex;
  std::vector<sensor::Scan> scans;
  std::unique_ptr<VelodyneInput> input;

  ReceivedVelodyne() {
    auto opened = VelodyneInput::open(0, [this](const sensor::Scan& scan) {
      const std::scoped_lock lock(mutex);
      scans.push_back(scan);
    });
    EXPECT_TRUE(opened) << opened.error().message;
    if (opened) input = std::move(*opened);
  }
  std::size_t count() {
    const std::scoped_lock lock(mutex);
    return scans.size();
  }
  /// So that the system's buffer does not run over.
  void wait_for_datagrams(std::uint64_t count) {
    EXPECT_TRUE(
        fleetmap::testing::eventually([&] { return input->counters().input.datagrams >= count; }, kPatience));
  }
};

TEST(VelodyneInput, PacketsOverUdpBecomeScans) {
  ReceivedVelodyne received;
  const UdpSender sender(received.input->port());
  const Stamp start = system_now();
  VelodyneDevice device(start.time_since_epoch());
  for (std::uint64_t sent = 1; sent <= 240; ++sent) {
    sender.send(device.next().bytes);
    if (sent % 20 == 0) received.wait_for_datagrams(sent);
  }
  ASSERT_TRUE(fleetmap::testing::eventually([&] { return received.count() >= 3; }, kPatience));
  const VelodyneInput::Counters counters = received.input->counters();
  EXPECT_EQ(counters.input.refused, 0u);
  EXPECT_EQ(counters.scans, 3u);
  received.input.reset();
  for (std::size_t k = 0; k < 3; ++k) {
    const sensor::Scan& scan = received.scans[k];
    EXPECT_NEAR(to_seconds(scan.stamp - start), 0.1 * static_cast<double>(k), 2e-4);
    EXPECT_NEAR(static_cast<double>(scan.points.size()), 28'935.0, 64.0);
    EXPECT_TRUE(scan.has_ring && scan.has_time);
  }
}

TEST(VelodyneInput, BytesThatAreNoPacketAreCounted) {
  ReceivedVelodyne received;
  const UdpSender sender(received.input->port());
  for (const std::size_t size : {0u, 10u, 1206u, 3000u}) sender.send(Bytes(size));
  received.wait_for_datagrams(4);
  EXPECT_EQ(received.input->counters().input.refused, 4u);
}

TEST(VelodyneInput, APortThatIsTakenIsAnErrorThatNamesIt) {
  ReceivedVelodyne received;
  const auto again = VelodyneInput::open(received.input->port(), [](const sensor::Scan&) {});
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message,
              HasSubstr("lidar.velodyne_port " + std::to_string(received.input->port())));
  EXPECT_THAT(again.error().message, HasSubstr("another program receives there"));
}

}  // namespace
}  // namespace fleetmap::apps
