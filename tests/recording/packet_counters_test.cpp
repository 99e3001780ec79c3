#include "packet_counters.hpp"

#include <gtest/gtest.h>

namespace fleetmap::recording {
namespace {

TEST(PacketCounters, EachFaultHasItsOwn) {
  EXPECT_EQ(counter_of(sensor::PacketFault::kSize), &Counters::packets_of_wrong_size);
  EXPECT_EQ(counter_of(sensor::PacketFault::kBlock), &Counters::packets_of_wrong_blocks);
  EXPECT_EQ(counter_of(sensor::PacketFault::kDevice), &Counters::packets_of_unknown_device);
}

}  // namespace
}  // namespace fleetmap::recording
