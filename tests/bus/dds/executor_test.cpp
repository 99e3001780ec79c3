#include "bus/dds/executor.hpp"

#include <gtest/gtest.h>

#include "bus/dds/inbox.hpp"
#include "bus/deadlines.hpp"

namespace fleetmap::bus {
namespace {

using testing::kAtOnce;

TEST(Executor, timers_that_are_always_due_leave_every_other_turn_to_posted_work) {
  Executor executor;
  int ticks = 0, posted = 0;
  const auto stop = executor.add_timer(std::chrono::nanoseconds(1), [&] { ++ticks; });
  const auto other = executor.add_timer(std::chrono::nanoseconds(1), [&] { ++ticks; });
  for (int k = 0; k < 50; ++k) executor.post([&] { ++posted; });
  while (ticks + posted < 100) ASSERT_TRUE(executor.run_one(Executor::Clock::time_point::max()));
  EXPECT_EQ(posted, 50);
  EXPECT_EQ(ticks, 50);
}

TEST(Executor, posted_work_that_never_ends_leaves_turns_to_timers) {
  Executor executor;
  int ticks = 0, posted = 0;
  const std::function<void()> again = [&] {
    ++posted;
    executor.post(again);
  };
  executor.post(again);
  const auto stop = executor.add_timer(std::chrono::nanoseconds(1), [&] { ++ticks; });
  while (ticks + posted < 100) ASSERT_TRUE(executor.run_one(Executor::Clock::time_point::max()));
  EXPECT_GE(ticks, 49);
}

TEST(Executor, a_flood_from_another_thread_is_refused_beyond_the_bound) {
  Executor executor;
  std::size_t taken = 0, ran = 0;
  for (std::size_t k = 0; k < 2 * Executor::kMaxPosted; ++k) taken += executor.try_post([&] { ++ran; });
  EXPECT_EQ(taken, Executor::kMaxPosted);
  while (executor.run_one(kAtOnce)) {
  }
  EXPECT_EQ(ran, taken);
  EXPECT_TRUE(executor.try_post([] {})) << "there is room again";
}

TEST(Executor, however_often_it_is_woken_it_returns_once) {
  Executor executor;
  for (int k = 0; k < 1000; ++k) executor.wake();
  EXPECT_TRUE(executor.run_one(kAtOnce));
  EXPECT_FALSE(executor.run_one(kAtOnce));
}

TEST(Inbox, a_flood_makes_no_more_dispatches_wait_than_messages) {
  Inbox inbox(4, 1000);
  int dispatches = 0;
  for (int k = 0; k < 10'000; ++k) dispatches += inbox.put(Bytes(10, static_cast<std::uint8_t>(k)));
  EXPECT_EQ(dispatches, 4);
  TopicStats stats;
  inbox.add_to(stats);
  EXPECT_EQ(stats.dropped_messages, 9'996u);
  // A large message takes the place of all; the dispatches of those find nothing.
  EXPECT_FALSE(inbox.put(Bytes(1000)));
  EXPECT_EQ(inbox.take()->cdr.size(), 1000u);
  for (int k = 1; k < 4; ++k) EXPECT_FALSE(inbox.take());
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(inbox.put(Bytes(1))) << "each message has its dispatch again";
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(inbox.take());
}

}  // namespace
}  // namespace fleetmap::bus
