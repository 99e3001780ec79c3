// The contract of Bus, tested with each implementation.

#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "bus/fleet.hpp"
#include "bus/topics.hpp"

namespace fleetmap::bus {
void PrintTo(const Topic& topic, std::ostream* out) { *out << topic.name; }
}  // namespace fleetmap::bus

namespace fleetmap::bus::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

class BusSuite : public ::testing::TestWithParam<FleetKind> {
 protected:
  std::unique_ptr<Fleet> make(const FleetConfig& config = {}) { return GetParam().make(config); }
};

TopicStats stats_of(const Bus& bus, const Topic& topic) {
  for (const TopicStats& stats : bus.stats()) {
    if (stats.link == topic.link && stats.topic == topic.name) return stats;
  }
  return {};
}

Bus::OnMessage into(std::vector<Message>& received) {
  return [&received](const Bytes& cdr) { received.push_back({cdr}); };
}

class EveryTopic : public ::testing::TestWithParam<std::tuple<FleetKind, Topic>> {};

TEST_P(EveryTopic, CarriesBytesUnchangedAndInOrder) {
  const auto& [kind, topic] = GetParam();
  const auto fleet = kind.make({});
  const std::size_t to = topic.link == Link::kOnboard ? 0 : 1;
  std::vector<Message> received;
  std::optional<AgentId> sender;
  const Handle handle = fleet->robot(to).subscribe(topic, [&](const Bytes& cdr) {
    received.push_back({cdr});
    sender = fleet->robot(to).sender();
  });
  ASSERT_TRUE(fleet->connect(topic, 0, 1, to, 1));

  // One after the other, since best effort may lose what comes faster than it is taken.
  std::vector<Message> sent;
  for (std::uint8_t i = 0; i < 20; ++i) {
    sent.push_back(message(50u * i, i));
    fleet->robot(0).publish(topic, sent.back().cdr);
    ASSERT_TRUE(fleet->run_until([&] { return received.size() == sent.size(); })) << "message " << int{i};
  }
  EXPECT_EQ(received, sent);
  EXPECT_EQ(sender,
            topic.link == Link::kOnboard ? std::nullopt : std::optional(AgentId::parse("r0").value()));
  EXPECT_EQ(fleet->robot(to).sender(), std::nullopt);
}

TEST_P(EveryTopic, CountsMessagesAndBytes) {
  const auto& [kind, topic] = GetParam();
  const auto fleet = kind.make({});
  const std::size_t to = topic.link == Link::kOnboard ? 0 : 1;
  std::vector<Message> received;
  const Handle handle = fleet->robot(to).subscribe(topic, into(received));
  ASSERT_TRUE(fleet->connect(topic, 0, 1, to, 1));
  for (std::size_t i = 1; i <= 3; ++i) {
    fleet->robot(0).publish(topic, message(96, 1).cdr);
    ASSERT_TRUE(fleet->run_until([&] { return received.size() == i; }));
  }
  const TopicStats sender = stats_of(fleet->robot(0), topic);
  EXPECT_EQ(sender.sent_messages, 3u);
  EXPECT_EQ(sender.sent_bytes, 300u);
  const TopicStats receiver = stats_of(fleet->robot(to), topic);
  EXPECT_EQ(receiver.received_messages, 3u);
  EXPECT_EQ(receiver.received_bytes, 300u);
  EXPECT_EQ(sender.dropped_messages + receiver.dropped_messages, 0u);
}

TEST_P(BusSuite, OnboardMessagesStayOnboard) {
  const auto fleet = make();
  std::vector<Message> own;
  std::vector<Message> other;
  std::vector<Message> fence;
  const Handle a = fleet->robot(0).subscribe(kState, into(own));
  const Handle b = fleet->robot(1).subscribe(kState, into(other));
  const Handle c = fleet->robot(1).subscribe(kControl, into(fence));
  ASSERT_TRUE(fleet->connect(kState, 0, 1, 0, 1));
  ASSERT_TRUE(fleet->connect(kControl, 0, 1, 1, 1));
  fleet->robot(0).publish(kState, message(10, 1).cdr);
  fleet->robot(0).publish(kControl, message(10, 2).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return own.size() == 1 && fence.size() == 1; }));
  EXPECT_THAT(other, IsEmpty());
}

TEST_P(BusSuite, ARobotDoesNotHearItselfOnARadio) {
  const auto fleet = make();
  for (const Topic& topic : {kSmall, kControl}) {
    std::vector<Message> own;
    std::vector<Message> other;
    const Handle a = fleet->robot(0).subscribe(topic, into(own));
    const Handle b = fleet->robot(1).subscribe(topic, into(other));
    ASSERT_TRUE(fleet->connect(topic, 0, 1, 1, 1));
    ASSERT_TRUE(fleet->connect(topic, 1, 1, 0, 1));
    fleet->robot(0).publish(topic, message(10, 1).cdr);
    ASSERT_TRUE(fleet->run_until([&] { return other.size() == 1; }));
    // The answer comes after anything that could have come back.
    fleet->robot(1).publish(topic, message(10, 2).cdr);
    ASSERT_TRUE(fleet->run_until([&] { return !own.empty(); }));
    EXPECT_THAT(own, ElementsAre(message(10, 2)));
    EXPECT_THAT(other, ElementsAre(message(10, 1)));
  }
}

TEST_P(BusSuite, TopicsAreSeparate) {
  const auto fleet = make();
  const Topic to_r1{Link::kShortRange, "fleetmap/request/r1", kControl.type, kControl.profile};
  const Topic to_r2{Link::kShortRange, "fleetmap/request/r2", kControl.type, kControl.profile};
  std::vector<Message> received;
  const Handle handle = fleet->robot(1).subscribe(to_r1, into(received));
  ASSERT_TRUE(fleet->connect(to_r1, 0, 1, 1, 1));
  fleet->robot(0).publish(to_r2, message(10, 2).cdr);
  fleet->robot(0).publish(to_r1, message(10, 1).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return !received.empty(); }));
  EXPECT_THAT(received, ElementsAre(message(10, 1)));
}

TEST_P(BusSuite, EverySubscriberOfARobotGetsEachMessage) {
  const auto fleet = make();
  std::vector<Message> first;
  std::vector<Message> second;
  const Handle a = fleet->robot(1).subscribe(kControl, into(first));
  const Handle b = fleet->robot(1).subscribe(kControl, into(second));
  ASSERT_TRUE(fleet->connect(kControl, 0, 1, 1, 1));
  fleet->robot(0).publish(kControl, message(10, 1).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return !first.empty() && !second.empty(); }));
  EXPECT_EQ(first, second);
  EXPECT_EQ(stats_of(fleet->robot(1), kControl).received_messages, 1u);
}

TEST_P(BusSuite, ALateSubscriberGetsOnlyWhatComesAfter) {
  const auto fleet = make();
  fleet->robot(0).publish(kControl, message(10, 1).cdr);
  std::vector<Message> received;
  // The first subscriber proves that message 2 has gone before the second one comes.
  std::vector<Message> early;
  const Handle a = fleet->robot(1).subscribe(kControl, into(early));
  ASSERT_TRUE(fleet->connect(kControl, 0, 1, 1, 1));
  fleet->robot(0).publish(kControl, message(10, 2).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return !early.empty(); }));
  const Handle b = fleet->robot(1).subscribe(kControl, into(received));
  fleet->robot(0).publish(kControl, message(10, 3).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return !received.empty(); }));
  EXPECT_THAT(received, ElementsAre(message(10, 3)));
  EXPECT_THAT(early, ElementsAre(message(10, 2), message(10, 3)));
}

TEST_P(BusSuite, AHandleThatGoesEndsItsSubscription) {
  const auto fleet = make();
  std::vector<Message> stays;
  std::vector<Message> goes;
  const Handle a = fleet->robot(1).subscribe(kControl, into(stays));
  Handle b = fleet->robot(1).subscribe(kControl, into(goes));
  ASSERT_TRUE(fleet->connect(kControl, 0, 1, 1, 1));
  fleet->robot(0).publish(kControl, message(10, 1).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return !stays.empty() && !goes.empty(); }));
  b.reset();
  fleet->robot(0).publish(kControl, message(10, 2).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return stays.size() == 2; }));
  EXPECT_THAT(goes, ElementsAre(message(10, 1)));
}

TEST_P(BusSuite, ASubscriptionMayEndInItsOwnCallbackAndComeBack) {
  const auto fleet = make();
  std::vector<Message> received;
  Handle handle;
  handle = fleet->robot(1).subscribe(kControl, [&](const Bytes& cdr) {
    received.push_back({cdr});
    handle.reset();
  });
  ASSERT_TRUE(fleet->connect(kControl, 0, 1, 1, 1));
  fleet->robot(0).publish(kControl, message(10, 1).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return !received.empty(); }));
  ASSERT_TRUE(fleet->connect(kControl, 0, 0, 1, 0));
  handle = fleet->robot(1).subscribe(kControl, into(received));
  ASSERT_TRUE(fleet->connect(kControl, 0, 1, 1, 1));
  fleet->robot(0).publish(kControl, message(10, 2).cdr);
  ASSERT_TRUE(fleet->run_until([&] { return received.size() == 2; }));
  EXPECT_THAT(received, ElementsAre(message(10, 1), message(10, 2)));
}

TEST_P(BusSuite, AHandleMayOutliveItsBus) {
  auto fleet = make();
  Handle subscription = fleet->robot(0).subscribe(kState, [](const Bytes&) {});
  Handle timer = fleet->robot(0).every(1h, [] {});
  fleet.reset();
  EXPECT_NO_THROW(subscription.reset());
  EXPECT_NO_THROW(timer.reset());
}

TEST_P(BusSuite, TimersKeepTheirPeriodUntilTheirHandleGoes) {
  const auto fleet = make({.robots = 1});
  Bus& bus = fleet->robot(0);
  const Stamp start = bus.now();
  std::vector<Stamp> fast;
  std::vector<Stamp> slow;
  Handle a = bus.every(10ms, [&] {
    fast.push_back(bus.now());
    if (fast.size() == 5) a.reset();
  });
  const Handle b = bus.every(25ms, [&] { slow.push_back(bus.now()); });
  ASSERT_TRUE(fleet->run_until([&] { return slow.size() == 4; }));
  ASSERT_EQ(fast.size(), 5u);
  EXPECT_GE(fast.front() - start, 10ms);
  EXPECT_GE(fast.back() - start, 50ms);
  EXPECT_GE(slow.back() - start, 100ms);
}

TEST_P(BusSuite, ATimerNeedsAPeriod) {
  const auto fleet = make({.robots = 1});
  EXPECT_THROW((void)fleet->robot(0).every(0ms, [] {}), std::logic_error);
}

TEST_P(BusSuite, WorkIsDoneInOrderAndFollowedOnTheCallbackThread) {
  const auto fleet = make({.robots = 1});
  Bus& bus = fleet->robot(0);
  std::vector<int> worked;  // by the worker only, until each item is done
  std::vector<int> done;
  const auto callback_thread = std::this_thread::get_id();
  for (int i = 0; i < 50; ++i) {
    bus.offload(
        Lane::kPerception, [&worked, i] { worked.push_back(i); },
        [&, i] {
          EXPECT_EQ(std::this_thread::get_id(), callback_thread);
          done.push_back(i);
        });
  }
  EXPECT_THAT(done, IsEmpty());
  ASSERT_TRUE(fleet->run_until([&] { return done.size() == 50; }));
  EXPECT_EQ(worked, done);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
}

TEST_P(BusSuite, WorkBeyondTheBoundIsRefusedAndWhatWasTakenIsDone) {
  const auto fleet = make({.robots = 1});
  Bus& bus = fleet->robot(0);
  std::promise<void> may_begin;
  std::size_t taken = 0, done = 0;
  const auto offload = [&](std::function<void()> work) {
    taken += bus.offload(Lane::kBackground, std::move(work), [&] { ++done; });
  };
  offload([begin = may_begin.get_future().share()] { begin.wait(); });
  for (std::size_t k = 0; k < Bus::kMaxWork + 10; ++k) offload([] {});
  EXPECT_GE(taken, Bus::kMaxWork);
  EXPECT_LE(taken, Bus::kMaxWork + 1) << "and the one under way";
  may_begin.set_value();
  EXPECT_TRUE(fleet->run_until([&] { return done == taken; }));
}

TEST_P(BusSuite, ABigPointCloudPassesOnboard) {
  const auto fleet = make({.robots = 1});
  std::vector<Message> received;
  const Handle handle = fleet->robot(0).subscribe(kSensor, into(received));
  ASSERT_TRUE(fleet->connect(kSensor, 0, 1, 0, 1));
  for (std::uint8_t i = 0; i < 5; ++i) {
    fleet->robot(0).publish(kSensor, message(3'000'000, i).cdr);
    ASSERT_TRUE(fleet->run_until([&] { return received.size() == i + 1u; })) << "cloud " << int{i};
    EXPECT_TRUE(received.back() == message(3'000'000, i));
  }
}

TEST_P(BusSuite, DropsOfAFullQueueAreCounted) {
  const auto fleet = make({.robots = 2, .queue_capacity = 8});
  std::vector<Message> received;
  const Handle handle = fleet->robot(1).subscribe(kBulk, into(received));
  ASSERT_TRUE(fleet->connect(kBulk, 0, 1, 1, 1));
  constexpr std::size_t kSent = 200;
  for (std::size_t i = 0; i < kSent; ++i)
    fleet->robot(0).publish(kBulk, message(100, static_cast<std::uint8_t>(i)).cdr);
  const auto dropped = [&] {
    return stats_of(fleet->robot(0), kBulk).dropped_messages +
           stats_of(fleet->robot(1), kBulk).dropped_messages;
  };
  // Nobody takes messages meanwhile, so some queue must overflow.
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (dropped() == 0 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  ASSERT_GT(dropped(), 0u);
  ASSERT_TRUE(fleet->run_until([&] { return received.size() + dropped() == kSent; }));
  EXPECT_EQ(stats_of(fleet->robot(0), kBulk).sent_messages, kSent);
  EXPECT_EQ(stats_of(fleet->robot(1), kBulk).received_messages, received.size());
  EXPECT_EQ(received.back(), message(100, static_cast<std::uint8_t>(kSent - 1))) << "the newest must stay";
}

TEST_P(BusSuite, ATopicWithTwoTypesIsABug) {
  const auto fleet = make({.robots = 1});
  const Handle handle = fleet->robot(0).subscribe(kState, [](const Bytes&) {});
  Topic other = kState;
  other.type = "fleetmap::Other";
  EXPECT_THROW(fleet->robot(0).publish(other, message(1, 1).cdr), std::logic_error);
}

constexpr FleetKind kKinds[] = {{"local", make_local_fleet}, {"dds", make_dds_fleet}};

INSTANTIATE_TEST_SUITE_P(Bus, BusSuite, ::testing::ValuesIn(kKinds),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Bus, EveryTopic,
                         ::testing::Combine(::testing::ValuesIn(kKinds),
                                            ::testing::Values(kSensor, kState, kSmall, kCloud, kControl,
                                                              kBulk)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) + "_" +
                                  std::get<1>(info.param).profile;
                         });

}  // namespace
}  // namespace fleetmap::bus::testing
