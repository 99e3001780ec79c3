#include "bus/dds/radio_topic.hpp"

#include <gmock/gmock.h>

#include <map>
#include <stdexcept>

#include "bus/dds/lone_radio.hpp"
#include "bus/topics.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using RadioTopic = LoneRadio;

/// Ids have 24 bits: two names among thousands share one, and both would get the other's messages.
TEST_F(RadioTopic, TwoTopicsOfOneEntityIdAreRefused) {
  std::map<std::uint32_t, Topic> topics;
  std::optional<std::pair<Topic, Topic>> same;
  for (int k = 0; !same; ++k) {
    const Topic next = small_topic("fleetmap/hold/r" + std::to_string(k));
    const auto [other, fresh] = topics.emplace(key_of(next), next);
    if (!fresh) same.emplace(other->second, next);
  }
  DdsBus& bus = start(robot("r1"));
  bus.advertise(same->first);
  EXPECT_THAT([&] { bus.advertise(same->second); },
              ThrowsMessage<std::logic_error>(HasSubstr("have the same entity id")));
}

TEST_F(RadioTopic, FollowsTheReadersOfTheOtherRobot) {
  DdsBus& sender = start(robot("r1"));
  DdsBus& reader = start(robot("r2"));
  sender.advertise(small_topic("t"));
  int came = 0;
  for (int round = 1; round <= 2; ++round) {
    Handle reads = reader.subscribe(small_topic("t"), [&](const Bytes&) { ++came; });
    ASSERT_TRUE(run_until([&] {
      return sender.matches(small_topic("t")).readers == 1 && reader.matches(small_topic("t")).writers == 1;
    })) << round;
    ASSERT_TRUE(run_until([&] {
      sender.publish(small_topic("t"), Bytes(20));
      return came > 0;
    }));
    reads.reset();
    ASSERT_TRUE(run_until([&] { return sender.matches(small_topic("t")).readers == 0; })) << round;
    EXPECT_EQ(reader.matches(small_topic("t")).writers, 0u);
    came = 0;
  }
}

/// With nobody to read it a message takes no air: it is not handed to Fast DDS, and is no drop.
TEST_F(RadioTopic, MessagesWithoutAReaderAreNoDrops) {
  DdsBus& bus = start(robot("r1"));
  for (int k = 0; k < 100; ++k) bus.publish(small_topic("t"), Bytes(1000));
  ASSERT_EQ(bus.stats().size(), 1u);
  EXPECT_EQ(bus.stats()[0].sent_messages, 100u);
  EXPECT_EQ(bus.stats()[0].dropped_messages, 0u);
}

/// A topic for one robot ends with its name; other robots listen at the same topic with theirs.
TEST_F(RadioTopic, OfThisRobotIsReadUnderItsNameAlone) {
  DdsBus& first = start(robot("r1"));
  DdsBus& second = start(robot("r2"));
  int came = 0;
  const Handle own = second.subscribe(small_topic("fleetmap/hold/r2"), [&](const Bytes&) { ++came; });
  first.advertise(small_topic("fleetmap/hold/r2"));
  first.advertise(small_topic("fleetmap/hold/r3"));
  ASSERT_TRUE(run_until([&] {
    first.publish(small_topic("fleetmap/hold/r2"), Bytes(20));
    return came > 0;
  }));
  EXPECT_EQ(first.matches(small_topic("fleetmap/hold/r2")).readers, 1u);
  EXPECT_EQ(first.matches(small_topic("fleetmap/hold/r3")).readers, 0u);
}

}  // namespace
}  // namespace fleetmap::bus::testing
