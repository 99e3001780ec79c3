#include "fleetmap/core/utc.hpp"

#include <gtest/gtest.h>

namespace fleetmap {
namespace {

TEST(Utc, IsWrittenToTheMillisecondBelow) {
  EXPECT_EQ(to_utc(stamp_from_ns(0)), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(to_utc(stamp_from_ns(1'795'630'359'500'999'999)), "2026-11-25T18:12:39.500Z");
  EXPECT_EQ(to_utc(stamp_from_ns(951'782'400'000'000'000)), "2000-02-29T00:00:00.000Z");
}

TEST(Utc, ClocksThatWereNeverSetAreNoMistake) {
  EXPECT_EQ(to_utc(stamp_from_ns(-1)), "1969-12-31T23:59:59.999Z");
  EXPECT_EQ(to_utc(Stamp::min()), "1677-09-21T00:12:43.145Z");
  EXPECT_EQ(to_utc(Stamp::max()), "2262-04-11T23:47:16.854Z");
}

}  // namespace
}  // namespace fleetmap
