#include "bus/event_queue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace fleetmap::bus {
namespace {

using std::chrono::seconds;

const Stamp kStart = stamp_from_ns(1'000'000'000);

class EventQueueTest : public ::testing::Test {
 protected:
  void add(Stamp stamp, char name) {
    queue_.at(stamp, [this, name] { order_ += name; });
  }
  EventQueue queue_{kStart};
  std::string order_;
};

TEST_F(EventQueueTest, RunsEventsByStampAndThenByOrderOfInsertion) {
  add(kStart + seconds(2), 'c');
  add(kStart + seconds(1), 'a');
  add(kStart + seconds(2), 'd');
  add(kStart + seconds(1), 'b');
  while (queue_.step()) {
  }
  EXPECT_EQ(order_, "abcd");
  EXPECT_EQ(queue_.now(), kStart + seconds(2));
}

TEST_F(EventQueueTest, TimeDoesNotRunBackwards) {
  add(kStart + seconds(1), 'a');
  queue_.step();
  add(kStart, 'b');
  EXPECT_TRUE(queue_.step());
  EXPECT_EQ(order_, "ab");
  EXPECT_EQ(queue_.now(), kStart + seconds(1));
}

TEST_F(EventQueueTest, AnEventMayAddEventsOfItsInstant) {
  queue_.at(kStart + seconds(1), [this] {
    order_ += 'a';
    queue_.post([this] { order_ += 'c'; });
  });
  add(kStart + seconds(1), 'b');
  queue_.run_until(kStart + seconds(1));
  EXPECT_EQ(order_, "abc");
}

TEST_F(EventQueueTest, RunsUntilAStampWithItsEvents) {
  add(kStart + seconds(1), 'a');
  add(kStart + seconds(2), 'b');
  add(kStart + seconds(3), 'c');
  queue_.run_until(kStart + seconds(2));
  EXPECT_EQ(order_, "ab");
  EXPECT_EQ(queue_.now(), kStart + seconds(2));
  queue_.run_until(kStart + seconds(1));
  EXPECT_EQ(queue_.now(), kStart + seconds(2));
  queue_.run_until(kStart + seconds(9));
  EXPECT_EQ(order_, "abc");
  EXPECT_EQ(queue_.now(), kStart + seconds(9)) << "time goes on without events";
  EXPECT_FALSE(queue_.step());
}

}  // namespace
}  // namespace fleetmap::bus
