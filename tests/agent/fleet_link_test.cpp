#include "fleetmap/agent/fleet_link.hpp"

#include <gtest/gtest.h>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/loop_closure/candidate_scheduler.hpp"
#include "store/items.hpp"
#include "support/robots.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using namespace std::chrono_literals;

exchange::Exchange make_exchange(store::Store& store, exchange::CloudClient& cloud_client) {
  exchange::ExchangeConfig config;
  config.fleet = {kSelf, kPeer};
  config.payload_size = [](const messages::Message& message) { return fleet_codec::encode(message).size(); };
  return exchange::Exchange::make(config, store, cloud_client, {}).value();
}

TEST(FleetLink, AskingWhomNobodyAnswersForIsNoProgress) {
  const testing::TemporaryFolder folder;
  const auto network = bus::LocalNetwork::create({}).value();
  bus::Bus& own = network->add_robot(kSelf);
  bus::Bus& other = network->add_robot(kPeer);
  network->set_position(kSelf, {0.0, 0.0, 0.0});
  network->set_position(kPeer, {10.0, 0.0, 0.0});
  auto store = store::Store::open(folder.path() / "store.db", kSelf).value();
  loop_closure::CandidateScheduler cloud_client(kSelf, {});
  exchange::Exchange exchange = make_exchange(store, cloud_client);
  FleetLink link(kSelf, own, exchange, [] {});

  const auto say = [&](const messages::Message& message) {
    other.publish(fleet_codec::topic_of(message), fleet_codec::encode(message));
  };
  int asked = 0;
  const messages::Message request = messages::ItemRequest{kPeer, kSelf, {{kSelf, 0, 1}}, {}};
  const bus::Handle heard = other.subscribe(
      fleet_codec::topic_of(messages::ItemRequest{kSelf, kPeer, {}, {}}), [&](const Bytes&) { ++asked; });
  say(messages::Digest{kPeer, {{kPeer, 0, 3}}, {}, {0}, {}});
  network->run_until(Stamp{} + 120s);
  EXPECT_GE(asked, 2) << "r1 asks for what it lacks, again and again";
  EXPECT_EQ(link.counters().last_useful, Stamp{});

  say(request);
  network->run_until(Stamp{} + 130s);
  EXPECT_GT(link.counters().last_useful, Stamp{} + 120s) << "who asks us is there";
}

/// A bus whose radio says so much itself each 20 ms.
class TalkativeRadio final : public bus::Bus {
 public:
  TalkativeRadio(bus::Bus& bus, std::uint64_t bytes_a_tick) : bus_(bus), bytes_a_tick_(bytes_a_tick) {}
  Stamp now() const override { return bus_.now(); }
  void publish(const bus::Topic& topic, const Bytes& cdr) override { bus_.publish(topic, cdr); }
  bus::Handle subscribe(const bus::Topic& topic, OnMessage on_message) override {
    return bus_.subscribe(topic, std::move(on_message));
  }
  std::optional<AgentId> sender() const override { return bus_.sender(); }
  bus::Handle every(Duration period, bus::Work callback) override {
    return bus_.every(period, std::move(callback));
  }
  bool offload(bus::Lane lane, bus::Work work, std::function<void()> done) override {
    return bus_.offload(lane, std::move(work), std::move(done));
  }
  std::vector<bus::TopicStats> stats() const override { return bus_.stats(); }
  std::uint64_t discovery_bytes(bus::Link link) const override {
    return link == bus::Link::kLongRange
               ? static_cast<std::uint64_t>(now().time_since_epoch() / 20ms) * bytes_a_tick_
               : 0;
  }

 private:
  bus::Bus& bus_;
  std::uint64_t bytes_a_tick_;
};

/// B that r1 sends in 20 s while clouds wait, beside a radio that says `bytes_a_tick` itself.
std::uint64_t sent_beside(std::uint64_t bytes_a_tick) {
  const testing::TemporaryFolder folder;
  const auto network = bus::LocalNetwork::create({}).value();
  TalkativeRadio radio(network->add_robot(kSelf), bytes_a_tick);
  network->add_robot(kPeer);
  auto store = store::Store::open(folder.path() / "store.db", kSelf).value();
  loop_closure::CandidateScheduler cloud_client(kSelf, {});
  exchange::Exchange exchange = make_exchange(store, cloud_client);
  const NodeId node{kSelf, 0};
  EXPECT_TRUE(store.put_node_with_submap(testing::make_node(kSelf, 0, Bytes(100, 1)), Bytes(100, 1)));
  EXPECT_TRUE(exchange.provide_cloud(node, Bytes(25'000, 7), radio.now()));
  FleetLink link(kSelf, radio, exchange, [] {});
  for (int k = 0; k < 20; ++k) {
    const messages::Message request = messages::CloudRequest{kPeer, kSelf, node, {}};
    exchange.on_message(request, radio.now());
    network->run_until(radio.now() + 1s);
  }
  std::uint64_t bytes = 0;
  for (const bus::TopicStats& stats : radio.stats())
    bytes += stats.link == bus::Link::kLongRange ? stats.sent_bytes : 0;
  return bytes;
}

TEST(FleetLink, OverheadOfTheRadioCountsAgainstTheShare) {
  const std::uint64_t alone = sent_beside(0), beside = sent_beside(150);  // 7500 B/s of a part of 9062
  EXPECT_GT(alone, 100'000u);
  EXPECT_LT(beside, alone / 3);
}

}  // namespace
}  // namespace fleetmap::agent
