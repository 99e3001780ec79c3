#include "fleetmap/recording/log_clock.hpp"

#include <gtest/gtest.h>

#include "bag_samples.hpp"

namespace fleetmap::recording {
namespace {

using namespace std::chrono_literals;
using namespace recording::testing;

/// One sample of a bag: seconds of its stamp and of its recording.
struct SampleTimes {
  double stamp, recorded;
};

/// The clock of a bag with these IMU samples, and fixes.
LogClock clock_of(const std::vector<SampleTimes>& imus, const std::vector<SampleTimes>& fixes = {}) {
  const auto at = [](double seconds) { return stamp_from_ns(kStart) + from_seconds(seconds); };
  LogClockFinder finder;
  const auto add = [&](auto sample, const SampleTimes& times) {
    sample.stamp = at(times.stamp);
    finder.add(sample, at(times.recorded));
  };
  add(sensor::Scan(), imus.front());
  for (const SampleTimes& times : imus) add(sensor::Imu(), times);
  for (const SampleTimes& times : fixes) add(sensor::Fix(), times);
  return finder.clock();
}

/// `count` samples a second apart, recorded `lag` later by a clock of this rate.
std::vector<SampleTimes> every_second(int count, double lag, double rate = 1.0) {
  std::vector<SampleTimes> times;
  for (int k = 0; k < count; ++k) times.push_back({1.0 * k, lag + rate * k});
  return times;
}

TEST(LogClock, ARateWithinFivePercentIsUsable) {
  for (const double rate : {0.96, 1.0, 1.04})
    EXPECT_TRUE(clock_of(every_second(8, 0.1, rate)).usable) << rate;
  for (const double rate : {0.94, 1.06}) EXPECT_FALSE(clock_of(every_second(8, 0.1, rate)).usable) << rate;
}

TEST(LogClock, WithoutTwoSecondsTheRateIsNotChecked) {
  EXPECT_TRUE(clock_of(every_second(2, 0.0, 3.0)).usable);
  EXPECT_FALSE(clock_of(every_second(3, 0.0, 3.0)).usable);
}

TEST(LogClock, ALagOfAMinuteIsThatOfDrivers) {
  EXPECT_EQ(clock_of(every_second(4, 59.0)).shift, 0ns);
  EXPECT_EQ(clock_of(every_second(4, 61.0)).shift, -61s);
  EXPECT_EQ(clock_of(every_second(4, -61.0)).shift, 61s);
}

TEST(LogClock, TheLeastLagOfASensorCounts) {
  std::vector<SampleTimes> times = every_second(6, 100.0);
  times[0].recorded += 0.9;  // a delayed message
  times[3].recorded -= 0.5;
  // The only scan was recorded with the first IMU sample: of both sensors the smaller lag is taken.
  EXPECT_EQ(clock_of(times).shift, -(99s + 500ms));
}

TEST(LogClock, OfThreeSensorsTheMiddleLagCounts) {
  // The clock of the receiver is right; those of scans and IMU are 400 s behind.
  const std::vector<SampleTimes> fixes{{400.0, 400.0}, {401.0, 401.0}};
  EXPECT_EQ(clock_of(every_second(4, 400.0), fixes).shift, -400s);
}

TEST(LogClock, OfNothingIsPlayedByStamps) {
  EXPECT_TRUE(LogClockFinder().clock().usable);
  EXPECT_EQ(LogClockFinder().clock().shift, 0ns);
}

TEST(LogClock, TwentySecondsAreEnough) {
  LogClockFinder finder;
  EXPECT_TRUE(finder.add(sensor::Imu{}, stamp_from_ns(kStart)));
  EXPECT_TRUE(finder.add(sensor::Imu{}, stamp_from_ns(kStart) + 20s));
  EXPECT_FALSE(finder.add(sensor::Imu{}, stamp_from_ns(kStart) + 21s));
}

}  // namespace
}  // namespace fleetmap::recording
