#include "fleetmap/bus/wire_overhead.hpp"

#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

TEST(WireBytes, AddsTheOverheadOfEveryDatagram) {
  EXPECT_EQ(wire_bytes(0), 100u);
  EXPECT_EQ(wire_bytes(1280), 1380u);
  EXPECT_EQ(wire_bytes(1281), 1281u + 2 * 100u);
  EXPECT_EQ(wire_bytes(8192), 8192u + 7 * 100u);
}

}  // namespace
}  // namespace fleetmap::bus
