#include "monitor/foxglove/subscriptions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::monitor::foxglove {
namespace {

using ::testing::HasSubstr;

std::vector<Channel> channels(std::size_t count) {
  std::vector<Channel> all;
  for (std::uint32_t id = 1; id <= count; ++id) all.push_back({id, "/x", ChannelKind::map, {}, 0});
  return all;
}

TEST(Subscriptions, a_message_is_due_once_and_only_the_newest) {
  auto all = channels(2);
  Subscriptions subscriptions;
  EXPECT_EQ(subscriptions.apply(Subscribe{{{77, 1}}}, all), "");
  EXPECT_FALSE(subscriptions.next_due(all)) << "there is no message yet";
  all[0].revision = all[1].revision = 3;
  const auto due = subscriptions.next_due(all);
  ASSERT_TRUE(due);
  EXPECT_EQ(due->id, 77u);
  EXPECT_EQ(due->channel, 1u);
  EXPECT_FALSE(subscriptions.next_due(all));
  all[0].revision = 9;
  EXPECT_TRUE(subscriptions.next_due(all));
  EXPECT_FALSE(subscriptions.next_due(all)) << "those before were never sent";
  EXPECT_EQ(subscriptions.apply(Unsubscribe{{77}}, all), "");
  all[0].revision = 10;
  EXPECT_FALSE(subscriptions.next_due(all));
  EXPECT_EQ(subscriptions.apply(Subscribe{{{77, 1}}}, all), "") << "the id is free again";
  EXPECT_TRUE(subscriptions.next_due(all)) << "the present message, at once";
}

TEST(Subscriptions, channels_take_turns) {
  auto all = channels(3);
  Subscriptions subscriptions;
  subscriptions.apply(Subscribe{{{1, 1}, {2, 2}, {3, 3}}}, all);
  std::vector<std::uint32_t> order;
  for (std::uint64_t revision = 1; order.size() < 7; ++revision) {
    for (Channel& channel : all) channel.revision = revision;
    order.push_back(subscriptions.next_due(all)->channel);
  }
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 2, 3, 1, 2, 3, 1}));
}

TEST(Subscriptions, what_cannot_be_followed_is_named_and_the_rest_is_followed) {
  auto all = channels(2);
  Subscriptions subscriptions;
  EXPECT_THAT(subscriptions.apply(Subscribe{{{1, 9}}}, all), HasSubstr("channel 9 does not exist"));
  EXPECT_THAT(subscriptions.apply(Subscribe{{{1, 0}}}, all), HasSubstr("channel 0 does not exist"));
  const std::string problems = subscriptions.apply(Subscribe{{{1, 7}, {2, 1}, {3, 4294967295u}}}, all);
  EXPECT_THAT(problems, HasSubstr("channel 7 does not exist; 1 more"));
  EXPECT_TRUE(subscriptions.has(1));
  EXPECT_THAT(subscriptions.apply(Subscribe{{{2, 2}}}, all), HasSubstr("subscription 2 exists already"));
  EXPECT_THAT(subscriptions.apply(Subscribe{{{3, 1}}}, all), HasSubstr("channel 1 is subscribed to already"));
  EXPECT_FALSE(subscriptions.has(2));
  EXPECT_THAT(subscriptions.apply(Unsubscribe{{5}}, all), HasSubstr("subscription 5 does not exist"));
  EXPECT_THAT(subscriptions.apply(NotOffered{"fetchAsset"}, all), HasSubstr("fetchAsset"));
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
