#include "fleetmap/agent/drive_guard.hpp"

#include <gtest/gtest.h>

#include "support/robots.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kStart;
using namespace std::chrono_literals;

/// A scan at `now`, its odometry and pose at once.
void see(DriveGuard& guard, Stamp now) {
  guard.on_scan(now);
  guard.on_odometry(now, now);
  guard.on_pose(now);
}

/// ms after kStart at which a check every DriveGuard::kPeriod first has a reason; -1: not within a second.
int first_stop(DriveGuard& guard) {
  for (Duration age{}; age < 1s; age += DriveGuard::kPeriod) {
    if (guard.check(kStart + age)) return static_cast<int>(age / 1ms);
  }
  return -1;
}

TEST(DriveGuard, NothingWasSeenYet) {
  DriveGuard guard;
  EXPECT_EQ(guard.check(kStart), StopReason::kNoScan);
  guard.on_scan(kStart);
  EXPECT_EQ(guard.check(kStart), StopReason::kNoOdometry);
  guard.on_odometry(kStart, kStart);
  EXPECT_EQ(guard.check(kStart), StopReason::kNoPose);
  guard.on_pose(kStart);
  EXPECT_EQ(guard.check(kStart), std::nullopt);
}

TEST(DriveGuard, StandsWithin300MsOfTheLastScan) {
  DriveGuard guard;
  see(guard, kStart);
  const int stop = first_stop(guard);
  EXPECT_GT(stop, 200) << "a LiDAR of 5 Hz, and one that is a little late";
  EXPECT_LE(stop, 280);
  EXPECT_EQ(guard.check(kStart + 1s), StopReason::kNoScan);
}

TEST(DriveGuard, EachOfScanOdometryAndPoseIsNeeded) {
  for (const StopReason missing : {StopReason::kNoScan, StopReason::kNoOdometry, StopReason::kNoPose}) {
    DriveGuard guard;
    see(guard, kStart);
    for (Duration age{}; age <= 500ms; age += 100ms) {
      const Stamp now = kStart + age;
      if (missing != StopReason::kNoScan) guard.on_scan(now);
      if (missing != StopReason::kNoOdometry) guard.on_odometry(now, now);
      if (missing != StopReason::kNoPose) guard.on_pose(now);
      EXPECT_EQ(guard.check(now).has_value(), age > 260ms) << to_string(missing);
    }
    EXPECT_EQ(guard.check(kStart + 500ms), missing);
    see(guard, kStart + 520ms);
    EXPECT_EQ(guard.check(kStart + 520ms), std::nullopt);
  }
}

TEST(DriveGuard, AResultThatComesLateIsNone) {
  DriveGuard guard;
  for (Duration age{}; age <= 2s; age += 100ms) {
    const Stamp now = kStart + age;
    see(guard, now);
    DriveGuard slow;
    slow.on_scan(now);
    slow.on_pose(now);
    slow.on_odometry(now - 301ms, now);
    EXPECT_EQ(slow.check(now), StopReason::kNoOdometry);
    slow.on_odometry(now - 299ms, now);
    EXPECT_EQ(slow.check(now), std::nullopt);
  }
}

TEST(DriveGuard, HeldRobotStopsUntilResumed) {
  DriveGuard guard;
  see(guard, kStart);
  guard.set_held(true);
  EXPECT_EQ(guard.check(kStart), StopReason::kHeld);
  guard.set_held(false);
  EXPECT_EQ(guard.check(kStart), std::nullopt);
}

TEST(DriveGuard, StoppedGuardNeverDrivesAgain) {
  DriveGuard guard;
  guard.stop();
  see(guard, kStart);
  guard.set_held(false);
  EXPECT_EQ(guard.check(kStart), StopReason::kStopping);
}

TEST(DriveGuard, AClockThatIsSetDoesNotLetItDriveOn) {
  for (const Duration step : {Duration(-100ms), Duration(-1h), Duration(1h)}) {
    DriveGuard guard;
    see(guard, kStart);
    ASSERT_EQ(guard.check(kStart + 100ms), std::nullopt);
    EXPECT_TRUE(guard.check(kStart + 110ms + step)) << to_seconds(step);
    see(guard, kStart + 120ms + step);
    EXPECT_EQ(guard.check(kStart + 120ms + step), std::nullopt) << "with the next scan all is well";
  }
}

}  // namespace
}  // namespace fleetmap::agent
