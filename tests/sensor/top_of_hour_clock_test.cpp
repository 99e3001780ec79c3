#include "fleetmap/sensor/top_of_hour_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::sensor {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Stamp kHourBegins = Stamp(hours(472'222));  // in 2023

std::uint32_t within_hour(Duration time) {
  return static_cast<std::uint32_t>(time % hours(1) / microseconds(1));
}

TEST(TopOfHourClock, OfASynchronisedDeviceIsUtcWhateverTheDelay) {
  TopOfHourClock clock;
  for (int k = 0; k < 100; ++k) {
    const Stamp fired = kHourBegins + seconds(100) + milliseconds(10 * k);
    const auto reading =
        clock.read(within_hour(fired.time_since_epoch()), fired + microseconds(500 + 977 * (k % 7)));
    EXPECT_EQ(reading.device, fired);
    EXPECT_FALSE(reading.restarted);
  }
  EXPECT_TRUE(clock.synchronised());
  EXPECT_EQ(clock.offset(), Duration::zero());
}

TEST(TopOfHourClock, RunsOnOverTheEndOfTheHour) {
  for (const Duration before : {seconds(2), seconds(1), seconds(0)}) {
    TopOfHourClock clock;
    for (int k = 0; k < 400; ++k) {
      const Stamp fired = kHourBegins - before + milliseconds(10 * k);
      EXPECT_EQ(clock.read(within_hour(fired.time_since_epoch()), fired + milliseconds(1)).device, fired);
    }
  }
  // The packet of the last ms arrives in the hour after.
  TopOfHourClock clock;
  EXPECT_EQ(clock.read(3'599'999'000, kHourBegins + milliseconds(3)).device, kHourBegins - milliseconds(1));
}

/// Devices without GPS count from when they were switched on, at any place within the hour.
TEST(TopOfHourClock, OfAFreeRunningDeviceIsMovedByTheLeastLag) {
  for (const int minutes_off : {0, 5, 29, 30, 31, 59}) {
    TopOfHourClock clock;
    const Duration off = std::chrono::minutes(minutes_off) + seconds(20);
    Stamp device;
    for (int k = 0; k < 200; ++k) {
      const Stamp fired = kHourBegins + seconds(100) + milliseconds(10 * k);
      const Duration delay = microseconds(200 + 1'000 * ((k * 7) % 5));
      const auto reading = clock.read(within_hour(fired.time_since_epoch() - off), fired + delay);
      EXPECT_FALSE(reading.restarted);
      if (k > 0) {
        EXPECT_EQ(reading.device - device, milliseconds(10)) << minutes_off;
      }
      device = reading.device;
      if (k >= 5) {
        EXPECT_NEAR(to_seconds(reading.device + clock.offset() - fired), 200e-6, 1e-6);
      }
    }
    EXPECT_FALSE(clock.synchronised());
  }
}

TEST(TopOfHourClock, FollowsADeviceThatWasSwitchedOnAgain) {
  TopOfHourClock clock;
  const auto read = [&](Duration device, Stamp arrival) { return clock.read(within_hour(device), arrival); };
  EXPECT_FALSE(read(seconds(500), kHourBegins).restarted);
  EXPECT_FALSE(read(seconds(501), kHourBegins + seconds(1)).restarted);
  EXPECT_TRUE(read(seconds(3), kHourBegins + seconds(20)).restarted);
  const auto after = read(seconds(4), kHourBegins + seconds(21));
  EXPECT_FALSE(after.restarted);
  EXPECT_NEAR(to_seconds(after.device + clock.offset() - kHourBegins), 21.0, 1e-6);
}

TEST(TopOfHourClock, ADeviceThatFindsGpsBecomesSynchronised) {
  TopOfHourClock clock;
  clock.read(within_hour(seconds(500)), kHourBegins);
  EXPECT_FALSE(clock.synchronised());
  const Stamp fired = kHourBegins + seconds(1);
  const auto reading = clock.read(within_hour(fired.time_since_epoch()), fired + milliseconds(1));
  EXPECT_TRUE(reading.restarted);
  EXPECT_TRUE(clock.synchronised());
  EXPECT_EQ(reading.device, fired);
}

TEST(TopOfHourClock, HostileTimesDoNotOverflow) {
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t a : {-kMax - 1, std::int64_t{-1}, std::int64_t{0}, kMax}) {
    for (const std::int64_t b : {-kMax - 1, std::int64_t{0}, kMax}) {
      TopOfHourClock clock;
      clock.read(0xffffffff, stamp_from_ns(a));
      const auto reading = clock.read(0, stamp_from_ns(b));
      EXPECT_LT(to_ns(reading.device + clock.offset()), kMax);
    }
  }
}

}  // namespace
}  // namespace fleetmap::sensor
