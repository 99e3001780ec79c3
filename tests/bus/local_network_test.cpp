#include "fleetmap/bus/local_network.hpp"

#include <gmock/gmock.h>

#include "bus/topics.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus {
namespace {

using fleetmap::testing::agent;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kBulk, testing::kCloud, testing::kSmall, testing::kState;
using namespace std::chrono_literals;

/// Three robots 10 m apart, and what each of them heard of a topic, with the time.
struct Network {
  explicit Network(const LocalNetworkConfig& config = {}) : network(LocalNetwork::create(config).value()) {
    double east = 0.0;
    for (const char* name : {"r1", "r2", "r3"}) {
      robots.push_back(&network->add_robot(agent(name)));
      network->set_position(agent(name), {east, 0.0, 0.0});
      east += 10.0;
    }
  }
  void listen(std::size_t robot, const Topic& topic) {
    handles.push_back(robots[robot]->subscribe(
        topic, [this](const Bytes& cdr) { heard.emplace_back(network->now(), cdr.at(0)); }));
  }
  std::unique_ptr<LocalNetwork> network;
  std::vector<Bus*> robots;
  std::vector<Handle> handles;
  std::vector<std::pair<Stamp, std::uint8_t>> heard;
};

TEST(LocalNetwork, NamesTheFieldThatIsWrong) {
  LocalNetworkConfig config;
  config.long_range.loss = 1.0;
  const auto network = LocalNetwork::create(config);
  ASSERT_FALSE(network);
  EXPECT_THAT(network.error().message, HasSubstr("long_range.loss must be in [0, 1)"));
  config = {};
  config.short_range.rate_bit_s = 0.0;
  EXPECT_THAT(LocalNetwork::create(config).error().message, HasSubstr("short_range.rate_bit_s"));
}

TEST(LocalNetwork, AMessageTakesItsAirtimeAndDelay) {
  LocalNetworkConfig config;
  config.long_range.rate_bit_s = 200e3;
  config.long_range.delay = 20ms;
  Network net(config);
  net.listen(1, kSmall);
  net.robots[0]->publish(kSmall, Bytes(900, 7));  // 1000 bytes on the wire: 40 ms
  net.network->run_until(Stamp{} + 1s);
  EXPECT_THAT(net.heard, ElementsAre(std::pair{Stamp{} + 60ms, std::uint8_t{7}}));
}

TEST(LocalNetwork, AllRobotsShareOneLongRangeMediumAndEveryReceiverCostsACopy) {
  Network net;
  for (std::size_t to : {0u, 1u, 2u}) net.listen(to, kCloud);
  for (std::size_t from : {0u, 1u, 2u}) {
    for (int i = 0; i < 10; ++i) net.robots[from]->publish(kCloud, Bytes(1150, 1));
  }
  // 3 senders x 2 receivers x 10 messages x 1250 bytes at 25,000 bytes a second are 3 s.
  net.network->run_until(Stamp{} + 10s);
  ASSERT_EQ(net.heard.size(), 60u);
  EXPECT_EQ(net.heard.back().first, Stamp{} + 3s + 20ms);
  std::uint64_t wire = 0;
  Duration air{};
  for (const LinkUse& use : net.network->link_use()) {
    wire += use.wire_bytes;
    air += use.airtime;
    EXPECT_EQ(use.copies, 20u);
  }
  EXPECT_EQ(wire, 75'000u);
  EXPECT_EQ(air, 3s);
}

TEST(LocalNetwork, TellsWhatARobotHeardOfEachOther) {
  LocalNetworkConfig config;
  config.long_range.loss = 0.1;
  config.long_range.delay = 20ms;
  config.long_range.queue_capacity = 10000;
  Network net(config);
  for (std::size_t to : {0u, 1u}) net.listen(to, kCloud);
  net.listen(1, kBulk);
  for (int i = 0; i < 1000; ++i) net.robots[0]->publish(kCloud, Bytes(900, 1));
  net.robots[2]->publish(kBulk, Bytes(100, 1));
  net.network->run_until(Stamp{} + 1h);
  const auto heard = net.network->take_heard(agent("r2"));
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].link, Link::kLongRange);
  EXPECT_EQ(heard[0].from, agent("r1"));
  EXPECT_EQ(heard[0].messages + heard[0].lost, 1000u);
  EXPECT_NEAR(static_cast<double>(heard[0].lost), 100.0, 40.0);
  EXPECT_EQ(heard[0].bytes, 1000u * heard[0].messages);
  EXPECT_EQ(heard[1].link, Link::kShortRange);
  EXPECT_EQ(heard[1].from, agent("r3"));
  EXPECT_EQ(heard[1].messages, 1u);
  EXPECT_TRUE(net.network->take_heard(agent("r2")).empty()) << "it was taken";
  EXPECT_TRUE(net.network->take_heard(agent("r3")).empty()) << "it does not listen";
}

TEST(LocalNetwork, TheDelayOfWhatIsHeardCountsFromItsPublication) {
  LocalNetworkConfig config;
  config.long_range.rate_bit_s = 200e3;
  config.long_range.delay = 20ms;
  Network net(config);
  net.listen(1, kSmall);
  for (int i = 0; i < 2; ++i) net.robots[0]->publish(kSmall, Bytes(900, 7));  // 40 ms in the air each
  net.network->run_until(Stamp{} + 1s);
  const auto heard = net.network->take_heard(agent("r2"));
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].delay, 60ms + 100ms);
}

TEST(LocalNetwork, RobotsTakeTurns) {
  Network net;
  net.listen(2, kCloud);
  for (int i = 0; i < 3; ++i) net.robots[0]->publish(kCloud, Bytes(1000, 1));
  for (int i = 0; i < 3; ++i) net.robots[1]->publish(kCloud, Bytes(1000, 2));
  net.network->run_until(Stamp{} + 10s);
  std::vector<int> order;
  for (const auto& [stamp, from] : net.heard) order.push_back(from);
  EXPECT_THAT(order, ElementsAre(1, 2, 1, 2, 1, 2));
}

TEST(LocalNetwork, LosesTheConfiguredShareAndRepeatsItWithTheSameSeed) {
  const auto arrivals = [](std::uint64_t seed) {
    LocalNetworkConfig config;
    config.long_range.loss = 0.1;
    config.long_range.queue_capacity = 10000;
    config.seed = seed;
    Network net(config);
    net.listen(1, kSmall);
    for (int i = 0; i < 5000; ++i) net.robots[0]->publish(kSmall, Bytes(10, static_cast<std::uint8_t>(i)));
    net.network->run_until(Stamp{} + 1h);
    EXPECT_EQ(net.network->link_use().front().lost + net.heard.size(), 5000u);
    return net.heard;
  };
  const auto first = arrivals(1);
  EXPECT_NEAR(static_cast<double>(first.size()), 4500.0, 100.0);
  EXPECT_EQ(arrivals(1), first);
  EXPECT_NE(arrivals(2), first);
}

TEST(LocalNetwork, ReliableMessagesAreSentAgainAtTheCostOfAir) {
  LocalNetworkConfig config;
  config.short_range.loss = 0.2;
  config.short_range.queue_capacity = 1000;
  Network net(config);
  net.listen(1, kBulk);
  for (int i = 0; i < 1000; ++i) net.robots[0]->publish(kBulk, Bytes(1000, 1));
  net.network->run_until(Stamp{} + 1h);
  EXPECT_EQ(net.heard.size(), 1000u);
  const auto use = net.network->link_use();
  EXPECT_NEAR(static_cast<double>(use.front().wire_bytes), 1100e3 / 0.8, 60e3);
}

TEST(LocalNetwork, ShortRangeEndsAtItsRange) {
  Network net;
  net.listen(1, kBulk);
  net.network->set_position(agent("r2"), {90.0, 0.0, 0.0});
  net.robots[0]->publish(kBulk, Bytes(10, 1));
  net.network->run_until(Stamp{} + 1s);
  net.network->set_position(agent("r2"), {54.0, 72.1, 0.0});
  net.robots[0]->publish(kBulk, Bytes(10, 2));
  net.network->run_until(Stamp{} + 2s);
  ASSERT_EQ(net.heard.size(), 1u);
  EXPECT_EQ(net.heard[0].second, 1);
}

TEST(LocalNetwork, ARobotThatLeavesDuringATransmissionMissesIt) {
  Network net;
  net.listen(1, kBulk);
  net.robots[0]->publish(kBulk, Bytes(1'000'000, 1));
  net.network->at(Stamp{} + 100ms, [&] { net.network->set_position(agent("r2"), {500.0, 0.0, 0.0}); });
  net.network->run_until(Stamp{} + 10s);
  EXPECT_TRUE(net.heard.empty());
  EXPECT_EQ(net.network->link_use().front().lost, 1u);
}

TEST(LocalNetwork, ABlackoutPassesNothingWhileItLasts) {
  Network net;
  net.listen(1, kSmall);
  net.listen(2, kSmall);
  net.network->add_blackout({Link::kLongRange, Stamp{} + 1s, Stamp{} + 2s, agent("r2")});
  for (int i = 0; i < 3; ++i) {
    net.network->at(Stamp{} + 500ms + i * 1s,
                    [&net, i] { net.robots[0]->publish(kSmall, Bytes(10, static_cast<std::uint8_t>(i))); });
  }
  net.network->run_until(Stamp{} + 5s);
  std::vector<int> heard;
  for (const auto& [stamp, what] : net.heard) heard.push_back(what);
  EXPECT_THAT(heard, ElementsAre(0, 0, 1, 2, 2)) << "only r3 hears the second";
}

TEST(LocalNetwork, NobodyPaysForATopicThatNobodyHears) {
  Network net;
  net.robots[0]->publish(kSmall, Bytes(10, 1));
  net.network->run_until(Stamp{} + 1s);
  EXPECT_TRUE(net.network->link_use().empty());
}

TEST(LocalNetwork, EventsOfOneInstantRunInTheOrderOfTheirInsertion) {
  Network net;
  std::vector<int> order;
  net.network->at(Stamp{} + 2s, [&] { order.push_back(3); });
  net.network->at(Stamp{} + 1s, [&] {
    order.push_back(1);
    net.network->at(Stamp{}, [&] { order.push_back(2); });  // past: now
  });
  net.network->run_until(Stamp{} + 2s);
  EXPECT_THAT(order, ElementsAre(1, 2, 3));
  EXPECT_EQ(net.network->now(), Stamp{} + 2s);
}

TEST(LocalNetwork, OnboardMessagesAndWorkTakeNoTime) {
  Network net;
  std::vector<int> order;
  const Handle handle = net.robots[0]->subscribe(kState, [&](const Bytes&) {
    order.push_back(2);
    net.robots[0]->offload(
        Lane::kBackground, [&] { order.push_back(3); }, [&] { order.push_back(4); });
  });
  net.network->at(Stamp{} + 1s, [&] {
    net.robots[0]->publish(kState, Bytes(4));
    order.push_back(1);
  });
  net.network->run_until(Stamp{} + 1s);
  EXPECT_THAT(order, ElementsAre(1, 2, 3, 4));
}

TEST(LocalNetwork, OffloadedWorkTakesItsVirtualTimeAndGivesTheSameWithAnyNumberOfThreads) {
  const auto log_with = [](unsigned threads) {
    LocalNetworkConfig config;
    config.threads = threads;
    config.perception_time = 30ms;
    config.background_time = 200ms;
    auto network = LocalNetwork::create(config).value();
    std::vector<std::string> log;
    std::array<int, 2> sums{};
    for (int r = 0; r < 2; ++r) {
      Bus& robot = network->add_robot(agent(r == 0 ? "r1" : "r2"));
      for (int k = 0; k < 5; ++k) {
        const Lane lane = k % 2 == 0 ? Lane::kPerception : Lane::kBackground;
        // Items of one lane run one at a time; those of the other lane touch something else.
        auto* sum = lane == Lane::kPerception ? &sums[static_cast<std::size_t>(r)] : nullptr;
        robot.offload(
            lane,
            [sum, k] {
              if (sum) *sum = *sum * 10 + k;
            },
            [&log, &network, r, k] {
              log.push_back(std::to_string(r) + ":" + std::to_string(k) + "@" +
                            std::to_string(to_seconds(network->now() - Stamp{})));
            });
      }
    }
    network->run_until(Stamp{} + 2s);
    log.push_back(std::to_string(sums[0]) + "," + std::to_string(sums[1]));
    return log;
  };
  const auto alone = log_with(0);
  EXPECT_EQ(log_with(1), alone);
  EXPECT_EQ(log_with(3), alone);
  EXPECT_THAT(alone, ElementsAre("0:0@0.030000", "1:0@0.030000", "0:2@0.060000", "1:2@0.060000",
                                 "0:4@0.090000", "1:4@0.090000", "0:1@0.200000", "1:1@0.200000",
                                 "0:3@0.400000", "1:3@0.400000", "24,24"));
}

TEST(LocalNetwork, AfterFinishWorkNothingFollowsFromWhatWasOffloaded) {
  LocalNetworkConfig config;
  config.threads = 1;
  config.background_time = 100ms;
  auto network = LocalNetwork::create(config).value();
  Bus& robot = network->add_robot(agent("r1"));
  bool first = false, second = false, followed = false;
  robot.offload(
      Lane::kBackground, [&] { first = true; }, [&] { followed = true; });
  robot.offload(
      Lane::kBackground, [&] { second = true; }, [&] { followed = true; });
  network->run_until(Stamp{} + 50ms);
  network->finish_work(agent("r1"));
  network->run_until(Stamp{} + 1s);
  EXPECT_TRUE(first);
  EXPECT_FALSE(second);
  EXPECT_FALSE(followed);
  robot.offload(
      Lane::kBackground, [&] { second = true; }, [&] { followed = true; });
  network->run_until(Stamp{} + 2s);
  EXPECT_TRUE(second);
  EXPECT_TRUE(followed);
}

TEST(LocalNetwork, ARobotThatIsSwitchedOffHearsAndDoesNothingAndMayComeBack) {
  Network net;
  net.listen(1, kSmall);
  int ticks = 0;
  const Handle timer = net.robots[1]->every(100ms, [&] { ++ticks; });
  net.robots[0]->publish(kSmall, Bytes(10, 1));
  net.network->run_until(Stamp{} + 250ms);
  net.network->remove_robot(agent("r2"));
  net.robots[0]->publish(kSmall, Bytes(10, 2));
  net.network->run_until(Stamp{} + 1s);
  EXPECT_EQ(ticks, 2);
  EXPECT_EQ(net.heard.size(), 1u);
  net.robots[1] = &net.network->add_robot(agent("r2"));
  net.listen(1, kSmall);
  net.robots[0]->publish(kSmall, Bytes(10, 3));
  net.network->run_until(Stamp{} + 2s);
  ASSERT_EQ(net.heard.size(), 2u);
  EXPECT_EQ(net.heard[1].second, 3);
}

TEST(LocalNetwork, AFullOnboardQueueDropsTheOldest) {
  LocalNetworkConfig config;
  config.onboard_queue_capacity = 3;
  Network net(config);
  net.listen(0, kState);
  for (std::uint8_t i = 0; i < 10; ++i) net.robots[0]->publish(kState, Bytes(4, i));
  net.network->run_until(Stamp{});
  std::vector<int> heard;
  for (const auto& [stamp, what] : net.heard) heard.push_back(what);
  EXPECT_THAT(heard, ElementsAre(7, 8, 9));
  EXPECT_EQ(net.robots[0]->stats().front().dropped_messages, 7u);
}

}  // namespace
}  // namespace fleetmap::bus
