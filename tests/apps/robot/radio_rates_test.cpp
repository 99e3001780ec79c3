#include "robot/radio_rates.hpp"

#include <gtest/gtest.h>

#include "fleetmap/core/time.hpp"
#include "support/robots.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using namespace std::chrono_literals;

constexpr Stamp kFirst{1000s};

bus::TopicStats topic(const std::string& name, bus::Link link, std::uint64_t sent, std::uint64_t received) {
  return {name, link, sent, 100 * sent, received, 100 * received, 0};
}

bus::HeardTraffic heard_traffic(std::uint64_t messages, std::uint64_t bytes, std::uint64_t lost,
                                Duration delay) {
  return {bus::Link::kLongRange, kPeer, messages, 0, bytes, lost, messages, delay};
}

TEST(RadioRates, TheLastSecondAgainstTheBudgetIsTheDifferenceOfTheCounters) {
  RadioRates rates;
  const auto first = rates.add({{}, 5000, 50}, {heard_traffic(1, 700, 0, 1ms)}, kFirst);
  EXPECT_EQ(first.sent, 0.0) << "since when these were counted is not known";
  EXPECT_EQ(first.received, 0.0);
  const auto second = rates.add({{}, 5600, 50}, {heard_traffic(2, 500, 0, 1ms)}, kFirst + 2s);
  EXPECT_DOUBLE_EQ(second.sent, 300.0);
  EXPECT_DOUBLE_EQ(second.received, 250.0);
}

TEST(RadioRates, KindsAreThoseOfTheRadiosWithTheOverheadOfEachMessage) {
  RadioRates rates;
  const auto counters = [](std::uint64_t k) {
    return RadioCounters{{topic("fleetmap/node", bus::Link::kLongRange, k, 0),
                          topic("fleetmap/node/r2", bus::Link::kLongRange, k, 2 * k),
                          topic("fleetmap/submap_chunk/r2", bus::Link::kShortRange, 0, 4 * k),
                          topic("fleetmap/digest", bus::Link::kLongRange, 7, 7),
                          topic("rt/points", bus::Link::kOnboard, k, k)},
                         0,
                         50};
  };
  rates.add(counters(10), {}, kFirst);
  EXPECT_EQ(rates.submap_rate(), 0.0);
  const auto radio = rates.add(counters(20), {}, kFirst + 5s);
  ASSERT_EQ(radio.kinds.size(), 2u) << "no digest came or went";
  EXPECT_EQ(radio.kinds[0].kind, "node");
  EXPECT_EQ(radio.kinds[0].link, "long_range");
  EXPECT_DOUBLE_EQ(radio.kinds[0].sent, 2 * 10 * 150 / 5.0);
  EXPECT_DOUBLE_EQ(radio.kinds[0].received, 20 * 150 / 5.0);
  EXPECT_EQ(radio.kinds[1].kind, "submap_chunk");
  EXPECT_DOUBLE_EQ(rates.submap_rate(), 40 * 150 / 5.0);
}

TEST(RadioRates, LossAndDelayAreMeansOverTheMessagesOfTheWindow) {
  RadioRates rates;
  rates.add({}, {heard_traffic(50, 99'999, 9, 1s)}, kFirst);
  rates.add({}, {heard_traffic(1, 200, 0, 10ms)}, kFirst + 1s);
  const auto radio = rates.add({}, {heard_traffic(3, 400, 4, 30ms)}, kFirst + 2s);
  ASSERT_EQ(radio.peers.size(), 1u);
  EXPECT_EQ(radio.peers[0].peer, kPeer);
  EXPECT_DOUBLE_EQ(radio.peers[0].received, 300.0);
  EXPECT_DOUBLE_EQ(radio.peers[0].loss, 0.5);
  EXPECT_NEAR(radio.peers[0].delay_s.value(), 0.025, 1e-9);
}

TEST(RadioRates, ADelayIsOfMessagesThatCarryATime) {
  RadioRates rates;
  bus::HeardTraffic some = heard_traffic(4, 400, 0, 30ms), none = heard_traffic(4, 400, 0, 0ms);
  some.timed = 1;
  none.timed = 0;
  rates.add({}, {}, kFirst);
  EXPECT_EQ(rates.add({}, {none}, kFirst + 1s).peers.at(0).delay_s, std::nullopt);
  EXPECT_NEAR(rates.add({}, {some}, kFirst + 2s).peers.at(0).delay_s.value(), 0.03, 1e-9);
}

TEST(RadioRates, SamplesOlderThanTheWindowAreForgotten) {
  RadioRates rates;
  rates.add({}, {}, kFirst);
  rates.add({}, {heard_traffic(1, 200, 0, 10ms)}, kFirst + 1s);
  monitor::RadioNow radio;
  for (int k = 2; k < 30; ++k) radio = rates.add({}, {}, kFirst + k * 1s);
  EXPECT_TRUE(radio.peers.empty());
}

TEST(RadioRates, TheKindOfATopicIsItsNameWithoutFleetAndRecipient) {
  EXPECT_EQ(kind_of_topic("fleetmap/cloud_fragment/r2"), "cloud_fragment");
  EXPECT_EQ(kind_of_topic("fleetmap/node"), "node");
  EXPECT_EQ(kind_of_topic("other"), "other");
}

}  // namespace
}  // namespace fleetmap::apps
