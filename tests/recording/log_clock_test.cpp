#include "fleetmap/recording/log_clock.hpp"

#include <gtest/gtest.h>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using namespace std::chrono_literals;
using namespace recording::testing;

/// One sample of a bag: seconds of its stamp and of its recording.
struct Times {
  double stamp, recorded;
};

/// The clock of a bag with these IMU samples, and fixes.
LogClock clock_of(const std::vector<Times>& imus, const std::vector<Times>& fixes = {}) {
  const fleetmap::testing::TemporaryFolder folder;
  const auto ns = [](double seconds) { return kStart + from_seconds(seconds).count(); };
  {
    auto bag = BagWriter::create(folder.path() / "bag").value();
    put(bag, ros_codec::topics::points(), ns(imus.front().recorded),
        ros_codec::encode(scan_at(ns(imus.front().stamp))));
    for (const Times& at : imus)
      put(bag, ros_codec::topics::imu(), ns(at.recorded), ros_codec::encode(imu_at(ns(at.stamp))));
    for (const Times& at : fixes)
      put(bag, ros_codec::topics::fix(), ns(at.recorded), ros_codec::encode(fix_at(ns(at.stamp))));
  }
  const auto clock = find_log_clock(folder.path() / "bag");
  EXPECT_TRUE(clock) << clock.error().message;
  return clock.value_or(LogClock{});
}

/// `count` samples a second apart, recorded `lag` later by a clock of this rate.
std::vector<Times> every_second(int count, double lag, double rate = 1.0) {
  std::vector<Times> times;
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
  std::vector<Times> times = every_second(6, 100.0);
  times[0].recorded += 0.9;  // a delayed message
  times[3].recorded -= 0.5;
  // The only scan was recorded with the first IMU sample: of both sensors the smaller lag is taken.
  EXPECT_EQ(clock_of(times).shift, -(99s + 500ms));
}

TEST(LogClock, OfThreeSensorsTheMiddleLagCounts) {
  // The clock of the receiver is right; those of scans and IMU are 400 s behind.
  const std::vector<Times> fixes{{400.0, 400.0}, {401.0, 401.0}};
  EXPECT_EQ(clock_of(every_second(4, 400.0), fixes).shift, -400s);
}

TEST(LogClock, WhatIsNoRecordingIsAnErrorAndKittiHasNoClock) {
  const fleetmap::testing::TemporaryFolder folder;
  EXPECT_FALSE(find_log_clock(folder.path() / "none"));
  const float point[4] = {1, 2, 3, 0};
  folder.write("drive/0.bin", {reinterpret_cast<const char*>(point), sizeof(point)});
  const auto clock = find_log_clock(folder.path() / "drive");
  ASSERT_TRUE(clock);
  EXPECT_TRUE(clock->usable);
  EXPECT_EQ(clock->shift, 0ns);
}

}  // namespace
}  // namespace fleetmap::recording
