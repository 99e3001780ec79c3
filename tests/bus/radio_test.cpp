#include "bus/radio.hpp"

#include <gmock/gmock.h>

#include <set>

#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus {
namespace {

using fleetmap::testing::agent;
using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A radio of 1000 bytes a second; a datagram takes 100 bytes beside its payload of at most 1280.
class RadioTest : public ::testing::Test {
 protected:
  struct Copy {
    std::uint8_t first = 0;
    Stamp at;
    bool operator==(const Copy&) const = default;
  };

  RadioTest() {
    config_.rate_bit_s = 8000.0;
    config_.delay = 20ms;
  }
  Radio& radio() {
    if (radio_) return *radio_;
    radio_.emplace(Link::kLongRange, config_, 5, events_);
    radio_->connect([this](const AgentId&, const AgentId& to) { return !out_of_reach_.contains(to); },
                    [this](const Transmission& copy) {
                      delivered_.push_back({copy.cdr->at(0), events_.now()});
                    },
                    [this](const Transmission& copy) { dropped_.push_back(copy.cdr->at(0)); });
    return *radio_;
  }
  void send(const char* from, std::uint8_t first, std::size_t bytes, const std::string& profile = "small") {
    Bytes cdr(bytes, 0);
    cdr[0] = first;
    radio().send({agent(from), agent("r9"), Topic{Link::kLongRange, "node", "Node", profile},
                  std::make_shared<const Bytes>(std::move(cdr))});
  }
  void run() { events_.run_until(events_.now() + 24h); }

  EventQueue events_{Stamp{}};
  RadioConfig config_;
  std::optional<Radio> radio_;
  std::set<AgentId> out_of_reach_;
  std::vector<Copy> delivered_;
  std::vector<int> dropped_;
};

TEST_F(RadioTest, ALargeMessageTakesTheAirOfAllItsDatagrams) {
  send("r1", 1, 3000);  // three datagrams, 3300 bytes
  send("r1", 2, 900);
  run();
  EXPECT_THAT(delivered_, ElementsAre(Copy{1, Stamp{} + 3320ms}, Copy{2, Stamp{} + 4320ms}));
  ASSERT_EQ(radio().use().size(), 1u);
  const LinkUse use = radio().use()[0];
  EXPECT_EQ(use.agent, agent("r1"));
  EXPECT_EQ(use.topic, "node");
  EXPECT_EQ(use.copies, 2u);
  EXPECT_EQ(use.wire_bytes, 4300u);
  EXPECT_EQ(use.airtime, 4300ms);
  EXPECT_EQ(use.lost + use.dropped, 0u);
}

TEST_F(RadioTest, RobotsTakeTurnsInTheOrderOfTheirNames) {
  for (std::uint8_t k = 0; k < 3; ++k) send("r1", k, 400);
  for (std::uint8_t k = 10; k < 12; ++k) send("r3", k, 400);
  send("r2", 20, 400);
  run();
  std::vector<int> order;
  for (const Copy& copy : delivered_) order.push_back(copy.first);
  EXPECT_THAT(order, ElementsAre(0, 20, 10, 1, 11, 2));
}

TEST_F(RadioTest, AFullQueueDropsItsOldestMessage) {
  config_.queue_capacity = 2;
  for (std::uint8_t k = 0; k < 5; ++k) send("r1", k, 400);  // the first is in the air at once
  EXPECT_THAT(dropped_, ElementsAre(1, 2));
  run();
  EXPECT_THAT(delivered_,
              ElementsAre(Copy{0, Stamp{} + 520ms}, Copy{3, Stamp{} + 1020ms}, Copy{4, Stamp{} + 1520ms}));
  EXPECT_EQ(radio().use()[0].dropped, 2u);
  EXPECT_EQ(radio().use()[0].copies, 3u);
}

TEST_F(RadioTest, ReceiverOutOfReachAtTheEndOfATransmissionMissesIt) {
  send("r1", 1, 900);
  events_.run_until(Stamp{} + 999ms);
  out_of_reach_.insert(agent("r9"));
  run();
  EXPECT_THAT(delivered_, IsEmpty());
  EXPECT_EQ(radio().use()[0].lost, 1u);
  EXPECT_EQ(radio().use()[0].airtime, 1s) << "it was sent all the same";
}

TEST_F(RadioTest, QueuedMessagesOfAForgottenRobotAreNotSent) {
  send("r1", 1, 900);
  send("r1", 2, 900);
  send("r2", 3, 900);
  radio().forget(agent("r1"));
  run();
  EXPECT_THAT(delivered_, ElementsAre(Copy{1, Stamp{} + 1020ms}, Copy{3, Stamp{} + 2020ms}));
}

TEST_F(RadioTest, AMessageIsLostWithAnyOfItsDatagrams) {
  config_.loss = 0.5;
  config_.queue_capacity = 4000;
  for (int k = 0; k < 4000; ++k) send("r1", 1, 3 * 1280);
  events_.run_until(Stamp{} + 24h);
  EXPECT_NEAR(static_cast<double>(delivered_.size()), 4000.0 / 8.0, 80.0);  // 4 sigma
  EXPECT_EQ(radio().use()[0].lost, 4000u - delivered_.size());
}

TEST_F(RadioTest, AReliableMessageIsRepeatedDatagramByDatagram) {
  config_.loss = 0.5;
  config_.queue_capacity = 2000;
  config_.reliable_profiles = {"bulk"};
  for (int k = 0; k < 2000; ++k) send("r1", 1, 1280, "bulk");
  run();
  EXPECT_EQ(delivered_.size(), 2000u);
  // Twice as much air, with a sigma of sqrt(2 * 2000) datagrams.
  EXPECT_NEAR(static_cast<double>(radio().use()[0].wire_bytes), 4000.0 * 1380.0, 4.0 * 63.0 * 1380.0);
}

}  // namespace
}  // namespace fleetmap::bus
