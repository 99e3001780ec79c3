#include "fleetmap/core/bounded_queue.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(BoundedQueue, OldestGivesWayAndIsCounted) {
  BoundedQueue<int> queue(3);
  for (int k = 0; k < 5; ++k) queue.push(k);
  EXPECT_EQ(queue.size(), 3u);
  EXPECT_EQ(queue.dropped(), 2u);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), 3);
  EXPECT_EQ(queue.pop(), 4);
  EXPECT_EQ(queue.pop(), std::nullopt);
}

}  // namespace
}  // namespace fleetmap
