#include "fleetmap/fault_injection/exchange_fleet.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "exchange_config.hpp"
#include "fleetmap/fault_injection/scenario.hpp"
#include "store/items.hpp"
#include "support/file_content.hpp"

namespace fleetmap::fault_injection {
namespace {

using testing::make_node;
using testing::random_bytes;

constexpr Duration kTick = std::chrono::milliseconds(50);

exchange::ExchangeConfig pair_config() {
  Scenario scenario;
  scenario.robots = 2;
  return exchange_config_of(scenario, false);
}

/// Two robots whose packets on the radio arrive after `delays`.
class PairFleet : private testing::TemporaryFolder, public ExchangeFleet {
 public:
  PairFleet() : ExchangeFleet(folder(), pair_config(), kTick) {}
  ~PairFleet() override { close_stores(); }

  using ExchangeFleet::damage_store;
  using ExchangeFleet::keep_store;
  using ExchangeFleet::kill;
  using ExchangeFleet::lose_store;
  using ExchangeFleet::put_back_store;

  const AgentId r1 = testing::agent("r1"), r2 = testing::agent("r2");
  std::vector<Duration> delays{kTick};
  std::vector<Packet> sent;

  Status start(const AgentId& name, Duration clock_offset = Duration::zero()) {
    return ExchangeFleet::start(name, {}, clock_offset,
                                [this](store::Store&) -> Result<std::uint16_t> { return session_++; });
  }
  void add_node(const AgentId& name, std::uint32_t seq) {
    const Bytes submap = random_bytes(50, seq);
    ASSERT_TRUE(robot(name).exchange->on_own_node(make_node(name, seq, submap), submap, now()));
  }
  std::filesystem::path database(const AgentId& name) const { return folder() / (name.str() + ".db"); }

 private:
  std::filesystem::path folder() const { return static_cast<const TemporaryFolder&>(*this) / ""; }
  void on_sent(const Packet& packet) override { sent.push_back(packet); }
  std::vector<Duration> arrivals(const Packet& packet, const AgentId&) override {
    return packet.outgoing.reach == messages::Reach::kLongRange ? delays : std::vector<Duration>{};
  }
  void on_event(const AgentId&, Robot&, const exchange::Event&) override {}
  void on_received(const AgentId&, Robot&, const loop_closure::ReceivedCloud&) override {}

  std::uint16_t session_ = 1;
};

TEST(ExchangeFleet, PacketsArriveAfterTheirDelayAndNotBefore) {
  PairFleet fleet;
  ASSERT_TRUE(fleet.start(fleet.r1) && fleet.start(fleet.r2));
  fleet.run_for(std::chrono::seconds(2));
  fleet.delays = {std::chrono::seconds(3)};
  fleet.add_node(fleet.r1, 0);
  const NodeId id{fleet.r1, 0};
  const auto arrived = [&] { return fleet.robot(fleet.r2).store->node(id) != nullptr; };
  const Stamp begun = fleet.now();
  fleet.run_for(std::chrono::seconds(20), arrived);
  ASSERT_TRUE(arrived());
  EXPECT_GE(fleet.now() - begun, std::chrono::seconds(3));
  EXPECT_LT(fleet.now() - begun, std::chrono::seconds(5));
}

TEST(ExchangeFleet, ALostPacketArrivesNowhereAndADoubledOneTwice) {
  for (const std::size_t copies : {0u, 2u}) {
    PairFleet fleet;
    ASSERT_TRUE(fleet.start(fleet.r1) && fleet.start(fleet.r2));
    fleet.delays.assign(copies, kTick);
    fleet.run_for(std::chrono::seconds(2));
    std::size_t to_r2 = 0, heard = 0;
    for (const Packet& packet : fleet.sent)
      to_r2 +=
          packet.from == fleet.r1 && std::holds_alternative<messages::AgentStatus>(packet.outgoing.message);
    for (const exchange::Event& event : fleet.robot(fleet.r2).events)
      heard += std::holds_alternative<exchange::PeerStatus>(event);
    EXPECT_GT(to_r2, 0u);
    EXPECT_EQ(heard, copies * to_r2);
  }
}

TEST(ExchangeFleet, AKilledRobotGoesOnWithTheFileThatItLeft) {
  PairFleet fleet;
  ASSERT_TRUE(fleet.start(fleet.r1));
  fleet.add_node(fleet.r1, 0);
  fleet.kill(fleet.r1);
  EXPECT_FALSE(fleet.runs(fleet.r1));
  ASSERT_TRUE(fleet.start(fleet.r1, std::chrono::hours(1)));
  EXPECT_EQ(fleet.robot(fleet.r1).store->nodes().size(), 1u);
  EXPECT_EQ(fleet.robot(fleet.r1).session, 2) << "in a session of its own";
  EXPECT_EQ(fleet.robot(fleet.r1).clock_offset, std::chrono::hours(1));
}

TEST(ExchangeFleet, AStoreIsKeptPutBackAndLost) {
  PairFleet fleet;
  ASSERT_TRUE(fleet.start(fleet.r1));
  fleet.add_node(fleet.r1, 0);
  fleet.keep_store(fleet.r1, ".kept");
  fleet.add_node(fleet.r1, 1);
  fleet.kill(fleet.r1);
  fleet.put_back_store(fleet.r1, ".kept");
  ASSERT_TRUE(fleet.start(fleet.r1));
  EXPECT_EQ(fleet.robot(fleet.r1).store->nodes().size(), 1u) << "that of the time of the copy";
  fleet.kill(fleet.r1);
  fleet.lose_store(fleet.r1);
  ASSERT_TRUE(fleet.start(fleet.r1));
  EXPECT_TRUE(fleet.robot(fleet.r1).store->nodes().empty());
}

TEST(ExchangeFleet, DamageIsOnePageOfTheDatabase) {
  PairFleet fleet;
  ASSERT_TRUE(fleet.start(fleet.r1));
  for (std::uint32_t k = 0; k < 40; ++k) fleet.add_node(fleet.r1, k);
  ASSERT_TRUE(fleet.robot(fleet.r1).store->sync());
  fleet.kill(fleet.r1);
  const auto bytes = [&] { return fleetmap::testing::file_text(fleet.database(fleet.r1)); };
  const std::string before = bytes();
  ASSERT_GT(before.size(), 4096u);
  fleet.damage_store(fleet.r1, 0.5);
  const std::string after = bytes();
  ASSERT_EQ(after.size(), before.size());
  std::size_t first = before.size(), last = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] == after[k]) continue;
    first = std::min(first, k);
    last = k;
  }
  EXPECT_LT(first, last);
  EXPECT_EQ(first / 4096, last / 4096);
}

}  // namespace
}  // namespace fleetmap::fault_injection
