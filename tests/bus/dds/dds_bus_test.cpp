// The parts that only the Fast DDS bus has: its configuration, its links and its counters.
#include "fleetmap/bus/dds_bus.hpp"

#include <gmock/gmock.h>

#include "bus/qos_directory.hpp"
#include "fleetmap/bus/wire_overhead.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(QosDirectory, ATopicWithAProfileThatTheFileLacksIsABug) {
  const auto bus = DdsBus::create(config_).value();
  EXPECT_THROW(bus->advertise({Link::kOnboard, "t", "T", "bulk"}), std::logic_error);
}

TEST_F(QosDirectory, ADisabledLinkNeedsNoFileAndCountsWhatItDrops) {
  fs::remove(directory_ / "short_range.xml");
  config_.short_range.enabled = false;
  const auto bus = DdsBus::create(config_).value();
  bus->publish({Link::kShortRange, "t", "T", "bulk"}, Bytes(10));
  ASSERT_EQ(bus->stats().size(), 1u);
  EXPECT_EQ(bus->stats()[0].dropped_messages, 1u);
}

TEST_F(QosDirectory, ARadioWhoseAddressIsNotThereKeepsNobodyFromMapping) {
  config_.long_range.address = "192.0.2.77";
  const auto bus = DdsBus::create(config_);
  ASSERT_TRUE(bus) << bus.error().message;
  EXPECT_THAT((*bus)->warnings(),
              ElementsAre(HasSubstr("no interface of this machine has 192.0.2.77 (it has lo "
                                    "127.0.0.1")));
  const Topic topic{Link::kLongRange, "t", "T", "small"};
  const Handle heard = (*bus)->subscribe(topic, [](const Bytes&) {});
  (*bus)->publish(topic, Bytes(10));
  EXPECT_EQ((*bus)->matches(topic).readers, 0u);
}

TEST_F(QosDirectory, AWrongConfigurationIsNamed) {
  const DdsBusConfig good = config_;
  config_.long_range.address.clear();
  config_.long_range.peers = {"127.0.0.1", "192.0.2.78"};
  EXPECT_THAT(error(),
              HasSubstr("long_range.address is not set, but 192.0.2.78 is another machine: give this "
                        "robot's own address on that radio; this machine has lo 127.0.0.1"));
  config_ = good;
  config_.long_range.address = "radio0";
  EXPECT_THAT(error(), HasSubstr("long_range.address is \"radio0\"; must be an IPv4 address"));
  config_ = good;
  config_.short_range.peers = {"10.0.0.2:0"};
  EXPECT_THAT(error(), HasSubstr("short_range.peers has \"10.0.0.2:0\""));
  config_ = good;
  config_.short_range.domain = config_.onboard.domain;
  EXPECT_THAT(error(), HasSubstr("short_range.domain must differ from onboard's"));
  config_ = good;
  config_.onboard.domain = 231;
  EXPECT_THAT(error(), HasSubstr("onboard.domain is 231; must be in [0, 230]"));
}

TEST_F(QosDirectory, OnboardThereIsNoMulticastOfOurs) {
  config_.onboard.multicast = true;
  EXPECT_THAT(error(), HasSubstr("onboard.multicast is for radios"));
}

TEST_F(QosDirectory, StopsAndRunsPostedCallbacks) {
  const auto bus = DdsBus::create(config_).value();
  std::vector<int> order;
  bus->post([&] { order.push_back(1); });
  bus->post([&] {
    order.push_back(2);
    bus->stop();
  });
  bus->run();
  EXPECT_THAT(order, ::testing::ElementsAre(1, 2));
  const std::atomic<bool> stop = true;
  bus->run_until(stop);
}

TEST_F(QosDirectory, APeerThatVanishesDoesNotHoldUpAWriter) {
  const Topic topic{Link::kShortRange, "chunk", "Chunk", "bulk"};
  const auto sender = DdsBus::create(config_).value();
  sender->advertise(topic);
  config_.agent = AgentId::parse("r2").value();
  for (int i = 0; i < 5; ++i) {
    auto receiver = DdsBus::create(config_).value();
    const Handle handle = receiver->subscribe(topic, [](const Bytes&) {});
    ASSERT_TRUE(run_both(*sender, *receiver, [&] { return sender->matches(topic).readers == 1; }));
    for (int n = 0; n < 300; ++n) sender->publish(topic, Bytes(8192));
    receiver.reset();  // in the middle of the burst
    EXPECT_TRUE(
        sender->run_until([&] { return sender->matches(topic).readers == 0; }, std::chrono::seconds(60)));
  }
}

TEST_F(QosDirectory, TrafficOfEachRobotIsCountedOnce) {
  const Topic topic{Link::kLongRange, "node", "Node", "small"};
  const auto sender = DdsBus::create(config_).value();
  sender->advertise(topic);
  config_.agent = AgentId::parse("r2").value();
  const auto receiver = DdsBus::create(config_).value();
  int came = 0;
  const Handle handle = receiver->subscribe(topic, [&](const Bytes&) { ++came; });
  ASSERT_TRUE(run_both(*sender, *receiver, [&] { return sender->matches(topic).readers == 1; }));
  for (int n = 0; n < 10; ++n) sender->publish(topic, Bytes(200));
  ASSERT_TRUE(run_both(*sender, *receiver,
                       [&] { return came == 10 && receiver->survey(Link::kShortRange).robots.size() == 1; }));
  std::vector<HeardTraffic> heard = receiver->take_heard_traffic();
  ASSERT_EQ(heard.size(), 2u) << "on the short range it has said Hello";
  EXPECT_EQ(heard[1].link, Link::kShortRange);
  EXPECT_EQ(heard[1].messages, 0u);
  EXPECT_GT(heard[1].hellos, 0u);
  EXPECT_EQ(heard[0].link, Link::kLongRange);
  EXPECT_EQ(heard[0].from.str(), "r1");
  EXPECT_EQ(heard[0].messages, 10u);
  EXPECT_EQ(heard[0].bytes, 10 * wire_bytes(200));
  EXPECT_EQ(heard[0].lost, 0u);
  EXPECT_GT(heard[0].delay, Duration::zero());
  EXPECT_LT(heard[0].delay, std::chrono::seconds(10));
  for (const HeardTraffic& again : receiver->take_heard_traffic())
    EXPECT_EQ(again.messages, 0u) << "since the last call nothing came";
  // At least a Hello of 156 bytes to each other; what was published is not among it.
  const std::uint64_t hellos = sender->discovery_bytes(Link::kLongRange);
  EXPECT_GE(hellos, 156u);
  EXPECT_LT(hellos, 20 * 300u);
  EXPECT_EQ(sender->discovery_bytes(Link::kOnboard), 0u);
}

TEST_F(QosDirectory, WithoutATimeoutTheBusRunsUntilTheConditionHolds) {
  auto bus = DdsBus::create(config_);
  ASSERT_TRUE(bus);
  int ticks = 0;
  const Handle timer = (*bus)->every(std::chrono::milliseconds(5), [&] { ++ticks; });
  EXPECT_TRUE((*bus)->run_until([&] { return ticks >= 3; }, Duration::max()));
  EXPECT_GE(ticks, 3);
}

}  // namespace
}  // namespace fleetmap::bus::testing
