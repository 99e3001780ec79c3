#include "fleetmap/recording/play_times.hpp"

#include <gtest/gtest.h>

#include "recording/timed_samples.hpp"

namespace fleetmap::recording {
namespace {

using testing::at;
using testing::kBegin;

using namespace std::chrono_literals;

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
