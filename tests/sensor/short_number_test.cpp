#include "short_number.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(ShortNumber, HasThreeDigits) {
  EXPECT_EQ(short_number(1.4142), "1.41");
  EXPECT_EQ(short_number(-0.012345), "-0.0123");
  EXPECT_EQ(short_number(20.0), "20");
  EXPECT_EQ(short_number(1234567.0), "1.23e+06");
}

}  // namespace
}  // namespace fleetmap
