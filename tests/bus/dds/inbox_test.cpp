#include "bus/dds/inbox.hpp"

#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

Bytes message(std::uint8_t number, std::size_t size = 1) { return Bytes(size, number); }

std::uint8_t number_of(std::optional<Inbox::Message> taken) { return taken ? taken->cdr.front() : 0; }

TopicStats counted(const Inbox& inbox) {
  TopicStats stats;
  inbox.add_to(stats);
  return stats;
}

TEST(Inbox, ReturnsMessagesInTheirOrderWithTheirSenders) {
  Inbox inbox(10, 100);
  const Inbox::Sender sender{1, 2, 3};
  EXPECT_TRUE(inbox.put(message(1), sender));
  EXPECT_TRUE(inbox.put(message(2)));
  const auto first = inbox.take();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->cdr, message(1));
  EXPECT_EQ(first->sender, sender);
  EXPECT_EQ(number_of(inbox.take()), 2);
  EXPECT_FALSE(inbox.take());
}

TEST(Inbox, DropsTheOldestBeyondItsNumberOfMessages) {
  Inbox inbox(2, 100);
  for (std::uint8_t k = 1; k <= 4; ++k) static_cast<void>(inbox.put(message(k)));
  EXPECT_EQ(number_of(inbox.take()), 3);
  EXPECT_EQ(number_of(inbox.take()), 4);
  EXPECT_EQ(counted(inbox).dropped_messages, 2u);
}

TEST(Inbox, DropsTheOldestBeyondItsBytesButKeepsOneMessageOfAnySize) {
  Inbox inbox(10, 100);
  static_cast<void>(inbox.put(message(1, 60)));
  static_cast<void>(inbox.put(message(2, 40)));
  EXPECT_EQ(counted(inbox).dropped_messages, 0u);
  static_cast<void>(inbox.put(message(3, 1)));
  EXPECT_EQ(counted(inbox).dropped_messages, 1u);
  static_cast<void>(inbox.put(message(4, 500)));
  EXPECT_EQ(counted(inbox).dropped_messages, 3u);
  EXPECT_EQ(number_of(inbox.take()), 4);
}

TEST(Inbox, BytesOfTakenMessagesAreFreeAgain) {
  Inbox inbox(10, 100);
  for (std::uint8_t k = 1; k <= 5; ++k) {
    static_cast<void>(inbox.put(message(k, 100)));
    EXPECT_EQ(number_of(inbox.take()), k);
  }
  EXPECT_EQ(counted(inbox).dropped_messages, 0u);
  EXPECT_EQ(counted(inbox).received_messages, 5u);
  EXPECT_EQ(counted(inbox).received_bytes, 500u);
}

/// A flood must not fill the executor with callbacks that find nothing.
TEST(Inbox, RequestsNoMoreDispatchesThanMessagesWait) {
  Inbox inbox(2, 100);
  EXPECT_TRUE(inbox.put(message(1)));
  EXPECT_TRUE(inbox.put(message(2)));
  EXPECT_FALSE(inbox.put(message(3))) << "it replaced the oldest, whose dispatch takes it";
  static_cast<void>(inbox.take());
  EXPECT_TRUE(inbox.put(message(4)));
}

}  // namespace
}  // namespace fleetmap::bus
