#include "fleetmap/agent/fleet_link.hpp"

#include <gtest/gtest.h>

#include "fleetmap/bus/local_bus.hpp"
#include "fleetmap/wire/messages.hpp"
#include "fleetmap/wire/topics.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;

AgentId id(const char* name) { return AgentId::parse(name).value(); }

exchange::Exchange make_exchange(store::Store& store) {
  exchange::ExchangeConfig config;
  config.fleet = {id("r1"), id("r2")};
  config.payload_size = [](const exchange::Message& message) { return wire::encode(message).size(); };
  return exchange::Exchange::make(config, store, {}).value();
}

TEST(FleetLink, AskingWhomNobodyAnswersForIsNoProgress) {
  const testing::TemporaryFolder folder;
  const auto network = bus::LocalNetwork::create({}).value();
  bus::Bus& own = network->add_robot(id("r1"));
  bus::Bus& other = network->add_robot(id("r2"));
  network->set_position(id("r1"), {0.0, 0.0, 0.0});
  network->set_position(id("r2"), {10.0, 0.0, 0.0});
  auto store = store::Store::open(folder.path() / "store.db", id("r1")).value();
  exchange::Exchange exchange = make_exchange(store);
  FleetLink link(id("r1"), own, exchange, [] {});

  const auto say = [&](const exchange::Message& message) {
    other.publish(wire::topic_of(message), wire::encode(message));
  };
  int asked = 0;
  const exchange::Message request = exchange::ItemRequest{id("r2"), id("r1"), {{id("r1"), 0, 1}}, {}};
  const bus::Handle heard = other.subscribe(wire::topic_of(exchange::ItemRequest{id("r1"), id("r2"), {}, {}}),
                                            [&](const Bytes&) { ++asked; });
  say(exchange::Digest{id("r2"), {{id("r2"), 0, 3}}, {}, {0}, {}});
  network->run_until(Stamp{} + 120s);
  EXPECT_GE(asked, 2) << "r1 asks for what it lacks, again and again";
  EXPECT_EQ(link.counters().last_useful, Stamp{});

  say(request);
  network->run_until(Stamp{} + 130s);
  EXPECT_GT(link.counters().last_useful, Stamp{} + 120s) << "who asks us is there";
}

}  // namespace
}  // namespace fleetmap::agent
