#include "fleetmap/recording/play_times.hpp"

#include <gtest/gtest.h>

namespace fleetmap::recording {
namespace {

using namespace std::chrono_literals;

const Stamp kBegin = stamp_from_ns(1'700'000'000'000'000'000);

template <class T>
Sample at(Duration time) {
  T sample;
  sample.stamp = kBegin + time;
  return sample;
}
Sample imu(Duration time) { return at<sensor::Imu>(time); }
Sample wheel(Duration time) { return at<sensor::Wheel>(time); }

TEST(PlayTimes, WithAUsableClockAreThoseOfRecordingAndItsShift) {
  PlayTimes times(LogClock{.usable = true, .shift = -300s});
  EXPECT_EQ(times.of(imu(0s), kBegin + 301s), kBegin + 1s);
  EXPECT_EQ(times.of(imu(50s), kBegin + 301s), kBegin + 1s) << "the stamp does not count";
}

TEST(PlayTimes, WithoutOneAreTheStamps) {
  PlayTimes unusable(LogClock{.usable = false, .shift = -300s});
  EXPECT_EQ(unusable.of(imu(5s), kBegin + 301s), kBegin + 5s);
  PlayTimes unknown(LogClock{.usable = true, .shift = -300s});
  EXPECT_EQ(unknown.of(imu(5s), std::nullopt), kBegin + 5s);
}

TEST(PlayTimes, AClockThatIsSetBackTwiceNeverRunsBackwards) {
  PlayTimes times(LogClock{.usable = false});
  EXPECT_EQ(times.of(imu(10s), std::nullopt), kBegin + 10s);
  EXPECT_EQ(times.of(imu(4s), std::nullopt), kBegin + 10s);
  EXPECT_EQ(times.of(imu(5s), std::nullopt), kBegin + 11s);
  EXPECT_EQ(times.of(imu(2s), std::nullopt), kBegin + 11s);
  EXPECT_EQ(times.of(imu(3s), std::nullopt), kBegin + 12s);
}

TEST(PlayTimes, EveryKindOfSensorHasAClockOfItsOwn) {
  PlayTimes times(LogClock{.usable = false});
  times.of(imu(10s), std::nullopt);
  times.of(imu(4s), std::nullopt);
  EXPECT_EQ(times.of(wheel(4s), std::nullopt), kBegin + 4s);
  EXPECT_EQ(times.of(imu(5s), std::nullopt), kBegin + 11s);
  EXPECT_EQ(times.of(wheel(5s), std::nullopt), kBegin + 5s);
}

}  // namespace
}  // namespace fleetmap::recording
