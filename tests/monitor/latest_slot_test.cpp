#include "monitor/latest_slot.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace fleetmap::monitor {
namespace {

TEST(LatestSlot, a_newer_value_replaces_one_that_was_not_taken) {
  LatestSlot<int> slot;
  EXPECT_FALSE(slot.take());
  EXPECT_TRUE(slot.put(std::make_shared<const int>(1))) << "the taker has to be told";
  EXPECT_FALSE(slot.put(std::make_shared<const int>(2)));
  EXPECT_EQ(*slot.take(), 2);
  EXPECT_FALSE(slot.take());
  EXPECT_TRUE(slot.put(std::make_shared<const int>(3)));
}

TEST(LatestSlot, values_are_taken_in_order_and_the_last_one_comes) {
  LatestSlot<int> slot;
  constexpr int kLast = 20'000;
  std::thread putter([&] {
    for (int k = 1; k <= kLast; ++k) slot.put(std::make_shared<const int>(k));
  });
  int before = 0;
  while (before < kLast) {
    const auto value = slot.take();
    if (!value) continue;
    EXPECT_GT(*value, before);
    before = *value;
  }
  putter.join();
}

}  // namespace
}  // namespace fleetmap::monitor
