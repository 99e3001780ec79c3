#include "devices/datagram_input.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <memory>

#include "apps/devices/patience.hpp"
#include "fleetmap/core/utc.hpp"
#include "support/eventually.hpp"
#include "support/udp_sender.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::UdpSender;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An input that takes datagrams that begin with a 1, whose sizes are collected.
struct ReceivedDatagrams {
  std::mutex mutex;
  std::vector<std::size_t> sizes;
  std::vector<Stamp> arrivals;
  std::unique_ptr<DatagramInput> input;

  ReceivedDatagrams() {
    auto opened = DatagramInput::open(
        0, "lidar.port", "topics.points",
        [this](ByteView payload, Stamp arrival) -> tl::expected<void, sensor::PacketRefusal> {
          if (payload.empty() || payload[0] != 1)
            return sensor::refused_packet(sensor::PacketFault::kBlock, "no 1");
          const std::scoped_lock lock(mutex);
          sizes.push_back(payload.size());
          arrivals.push_back(arrival);
          return {};
        });
    EXPECT_TRUE(opened) << opened.error().message;
    if (opened) input = std::move(*opened);
  }
  void wait_for(std::uint64_t count) {
    EXPECT_TRUE(
        fleetmap::testing::eventually([&] { return input->counters().datagrams >= count; }, kPatience));
  }
};

TEST(DatagramInput, DatagramsOfAnySizeComeWithTheirTimeOfArrival) {
  ReceivedDatagrams received;
  const UdpSender sender(received.input->port());
  const Stamp before = system_now();
  for (const std::size_t size : {1u, 1206u, 33'024u, 65'000u}) sender.send(Bytes(size, 1));
  received.wait_for(4);
  const std::scoped_lock lock(received.mutex);
  EXPECT_THAT(received.sizes, ElementsAre(1u, 1206u, 33'024u, 65'000u));
  for (const Stamp arrival : received.arrivals) {
    EXPECT_GE(arrival, before - std::chrono::milliseconds(1));
    EXPECT_LE(arrival, system_now());
  }
}

TEST(DatagramInput, RefusalsAreCountedAndAreNoSignOfTheDevice) {
  ReceivedDatagrams received;
  const UdpSender other(received.input->port(), "127.0.0.2"), device(received.input->port(), "127.0.0.1");
  other.send(Bytes(10, 7));
  received.wait_for(1);
  device.send(Bytes(10, 1));
  received.wait_for(2);
  EXPECT_EQ(received.input->counters().refused, 1u);
  EXPECT_EQ(received.input->counters().of_other_devices, 0u);
}

TEST(DatagramInput, ASecondDeviceIsRefusedWhileTheFirstSends) {
  ReceivedDatagrams received;
  const UdpSender first(received.input->port(), "127.0.0.1"), second(received.input->port(), "127.0.0.2");
  std::uint64_t sent = 0;
  for (const UdpSender* sender : {&first, &second, &first}) {
    sender->send(Bytes(10, 1));
    received.wait_for(++sent);
  }
  EXPECT_EQ(received.input->counters().of_other_devices, 1u);
  EXPECT_EQ(received.input->counters().refused, 0u);
}

TEST(DatagramInput, APortThatIsTakenIsAnErrorWithItsKeyAndTheRemedy) {
  ReceivedDatagrams received;
  const auto again =
      DatagramInput::open(received.input->port(), "lidar.port", "topics.points",
                          [](ByteView, Stamp) { return tl::expected<void, sensor::PacketRefusal>(); });
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("lidar.port " + std::to_string(received.input->port())));
  EXPECT_THAT(again.error().message,
              HasSubstr("another program receives there; end it, or take its topic as topics.points"));
}

}  // namespace
}  // namespace fleetmap::apps
