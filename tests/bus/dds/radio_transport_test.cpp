// Datagrams on a radio, with keys and without, as the wire sees them.
#include <random>

#include "bus/dds/lone_radio.hpp"
#include "bus/dds/participant_qos.hpp"
#include "bus/dds/udp_end.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/core/utc.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus::testing {
namespace {

constexpr std::size_t kIpUdp = WireOverhead{}.ip_udp;

class RadioTransport : public LoneRadio, public ::testing::WithParamInterface<bool> {
 protected:
  DdsBusConfig of(const char* id) {
    DdsBusConfig config = robot(id);
    if (GetParam()) config.keys = std::make_shared<const trust::Credentials>(fleet_.member(id));
    return config;
  }
  Bytes random_message() {
    Bytes cdr{0, 1, 0, 0};
    cdr.resize(std::uniform_int_distribution<std::size_t>(4, 300)(random_));
    for (std::size_t k = 4; k < cdr.size(); ++k) cdr[k] = static_cast<std::uint8_t>(random_());
    return cdr;
  }

  fleetmap::testing::FleetOfKeys fleet_{.made = system_now()};
  std::mt19937 random_{1};
};

// Fast DDS's UDP transport overwrites the end of a datagram that has one byte in the wrong place.
TEST_P(RadioTransport, EachOfManyMessagesArrivesAsItWasSent) {
  const Topic topic{Link::kLongRange, "note", "Note", "small"};
  DdsBus& from = start(of("r1"));
  DdsBus& to = start(of("r2"));
  std::vector<Bytes> sent, came;
  const Handle handle = to.subscribe(topic, [&](const Bytes& cdr) { came.push_back(cdr); });
  from.advertise(topic);
  ASSERT_TRUE(run_until([&] { return from.matches(topic).readers == 1 && to.matches(topic).writers == 1; }));
  while (sent.size() < 3000) {
    for (int k = 0; k < 20; ++k) from.publish(topic, sent.emplace_back(random_message()));
    ASSERT_TRUE(run_until([&] { return came.size() >= sent.size(); }))
        << came.size() << " of " << sent.size();
    ASSERT_EQ(came.size(), sent.size());
  }
  EXPECT_TRUE(came == sent);
  EXPECT_TRUE(to.survey(Link::kLongRange).refused.empty());
}

TEST_P(RadioTransport, TakesTheBytesOnTheWireThatAreCounted) {
  DdsBusConfig config = of("r1");
  const auto port = static_cast<std::uint16_t>(7410 + 250 * first_test_domain() + 20);
  UdpEnd place(port);
  config.long_range.peers = {"127.0.0.1:" + std::to_string(port)};
  DdsBus& bus = start(config);
  std::size_t on_the_wire = 0, datagrams = 0;
  ASSERT_TRUE(run_until([&] {
    while (const auto datagram = place.datagram()) on_the_wire += datagram->size() + kIpUdp, ++datagrams;
    return datagrams >= 3;
  }));
  const std::size_t counted = bus.discovery_bytes(Link::kLongRange);
  EXPECT_GE(on_the_wire, counted);
  EXPECT_LE(on_the_wire, counted + 3 * datagrams) << "payloads are padded to four bytes";
}

INSTANTIATE_TEST_SUITE_P(Keys, RadioTransport, ::testing::Bool(),
                         [](const auto& with) { return with.param ? "Sealed" : "Plain"; });

}  // namespace
}  // namespace fleetmap::bus::testing
