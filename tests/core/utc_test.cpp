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

TEST(Utc, IsReadAsItWasWritten) {
  for (const std::int64_t ms : {0LL, 951'782'400'000LL, 1'795'630'359'500LL, 9'000'000'000'001LL}) {
    const Stamp stamp = stamp_from_ns(ms * 1'000'000);
    EXPECT_EQ(from_utc(to_utc(stamp)), stamp) << to_utc(stamp);
  }
  EXPECT_EQ(from_utc("2026-11-25T18:12:39Z"), stamp_from_ns(1'795'630'359'000'000'000));
  EXPECT_EQ(from_utc("2026-11-25T18:12:39.123456789Z"), stamp_from_ns(1'795'630'359'123'456'789));
}

TEST(Utc, OtherTextsAreNone) {
  for (const char* text :
       {"", "2026-11-25", "2026-11-25T18:12:39", "2026-11-25T18:12:39+01:00", "2026-02-30T18:12:39Z",
        "2026-11-25T24:12:39Z", "2026-11-25T18:60:39Z", "2026-11-25T18:12:61Z", "1969-11-25T18:12:39Z",
        "2262-11-25T18:12:39Z", "2026-11-25T18:12:39.Z", "2026-11-25T18:12:-9Z", "2026-11-25T18:12:39.5e3Z"})
    EXPECT_FALSE(from_utc(text)) << text;
}

}  // namespace
}  // namespace fleetmap
