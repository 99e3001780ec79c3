#include "fleetmap/bus/wire_overhead.hpp"

#include <gtest/gtest.h>

namespace fleetmap::bus {
namespace {

TEST(WireBytes, AddsTheOverheadOfEveryDatagram) {
  EXPECT_EQ(wire_bytes(0), 160u);
  EXPECT_EQ(wire_bytes(1280), 1440u);
  EXPECT_EQ(wire_bytes(1281), 1281u + 2 * 160u);
  EXPECT_EQ(wire_bytes(8192), 8192u + 7 * 160u);
}

}  // namespace
}  // namespace fleetmap::bus
