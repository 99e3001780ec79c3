#include "fleetmap/fleet_codec/topics.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "random_messages.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::RandomMessages;

TEST(FleetTopics, EveryMessageToAnAgentReachesItsInboxAndOnlyOnce) {
  RandomMessages random(21);
  const AgentId self = *AgentId::parse("r2");
  const auto inbox = inbox_topics(self);
  std::set<std::pair<bus::Link, std::string>> names;
  for (const auto& topic : inbox) EXPECT_TRUE(names.insert({topic.link, topic.name}).second) << topic.name;
  std::set<std::pair<bus::Link, std::string>> used;
  for (messages::Message message : random.one_of_each()) {
    std::visit(
        [&](auto& m) {
          if constexpr (requires { m.to; }) m.to = self;
        },
        message);
    const auto reach_it = [&](const bus::Topic& topic) {
      EXPECT_EQ(names.count({topic.link, topic.name}), 1u) << topic.name;
      used.insert({topic.link, topic.name});
    };
    reach_it(topic_of(message));
    const auto to = messages::recipient_of(message);
    reach_it(topic_of({messages::Reach::kShortRange, to, message}));
    if (!messages::may_go_one_by_one(message)) continue;
    reach_it(topic_of({messages::Reach::kShortRange, self, message}));
    reach_it(topic_of({messages::Reach::kLongRange, self, message}));
  }
  EXPECT_EQ(used, names);
}

TEST(FleetTopics, BothRadiosCarryAKindUnderOneNameWithTheirOwnProfiles) {
  const AgentId r1 = *AgentId::parse("r1");
  const messages::CloudFragment fragment{r1, r1, {r1, 0}, {}, 1, 0, 1, {}};
  const bus::Topic far = topic_of({messages::Reach::kLongRange, r1, fragment});
  const bus::Topic near = topic_of({messages::Reach::kShortRange, r1, fragment});
  EXPECT_EQ(far.name, near.name);
  EXPECT_EQ(far.profile, "cloud");
  EXPECT_EQ(near.profile, "bulk");
  EXPECT_EQ(near.link, bus::Link::kShortRange);
  EXPECT_EQ(reach_of(near.link), messages::Reach::kShortRange);
  EXPECT_EQ(reach_of(far.link), messages::Reach::kLongRange);
}

TEST(FleetTopics, AddressedMessagesOnlyReachTheirRecipient) {
  const AgentId r1 = *AgentId::parse("r1");
  const messages::CloudFragment fragment{r1, r1, {r1, 0}, {}, 1, 0, 1, {}};
  EXPECT_EQ(topic_of(fragment).name, "fleetmap/cloud_fragment/r1");
  EXPECT_EQ(topic_of(fragment).profile, "cloud");
  EXPECT_EQ(topic_of(fragment).link, bus::Link::kLongRange);
  for (const auto& topic : inbox_topics(*AgentId::parse("r2")))
    EXPECT_NE(topic.name, topic_of(fragment).name);
}

}  // namespace
}  // namespace fleetmap::fleet_codec
