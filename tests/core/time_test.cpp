#include "fleetmap/core/time.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fleetmap {
namespace {

using namespace std::chrono_literals;

TEST(Time, StampsCountNanosecondsFromTheEpoch) {
  EXPECT_EQ(to_ns(stamp_from_ns(1'234'567'890'123'456'789)), 1'234'567'890'123'456'789);
  EXPECT_EQ(to_ns(Stamp{}), 0);
  EXPECT_EQ(to_ns(stamp_from_ns(-5)), -5) << "before the epoch, too";
  EXPECT_EQ(stamp_from_ns(1'500'000'000) - stamp_from_ns(500'000'000), 1s);
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(to_ns(stamp_from_ns(kLast)), kLast);
}

TEST(Time, SecondsKeepTheirFraction) {
  EXPECT_DOUBLE_EQ(to_seconds(1'500ms), 1.5);
  EXPECT_DOUBLE_EQ(to_seconds(Duration{-250'000'000}), -0.25);
  EXPECT_DOUBLE_EQ(to_seconds(Duration{1}), 1e-9);
  EXPECT_DOUBLE_EQ(to_seconds(stamp_from_ns(2'250'000'000)), 2.25);
}

TEST(Time, SecondsAreRoundedToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(2.5), 2'500ms);
  EXPECT_EQ(from_seconds(1.4e-9), 1ns);
  EXPECT_EQ(from_seconds(1.6e-9), 2ns);
  EXPECT_EQ(from_seconds(-1.6e-9), -2ns);
  EXPECT_EQ(from_seconds(0.1 + 0.2), 300ms) << "the sum is above 0.3 by 5e-17";
  // Truncation would lose a nanosecond of many of these.
  for (std::int64_t ms = -2'000; ms <= 2'000; ++ms) {
    EXPECT_EQ(from_seconds(static_cast<double>(ms) / 1e3), std::chrono::milliseconds(ms));
  }
}

TEST(Time, ADayInNanosecondsSurvivesSeconds) {
  const Duration day = 24h + 1ns;
  EXPECT_EQ(from_seconds(to_seconds(day)), day);
}

}  // namespace
}  // namespace fleetmap
