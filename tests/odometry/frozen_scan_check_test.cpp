#include "frozen_scan_check.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::odometry {
namespace {

sensor::Scan scan_from(float first, std::size_t points = 2000) {
  sensor::Scan scan;
  scan.points.resize(points);
  for (std::size_t k = 0; k < points; ++k) {
    const float x = first + 0.001f * static_cast<float>(k);
    scan.points[k].position = {x, 1.0f, k % 7 == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.0f};
  }
  return scan;
}

TEST(FrozenScanCheck, RefusesRepeatedPointsWhileTheRobotMoves) {
  FrozenScanCheck check;
  EXPECT_FALSE(check.frozen(scan_from(1.0f), true));
  EXPECT_TRUE(check.frozen(scan_from(1.0f), true));
  EXPECT_FALSE(check.frozen(scan_from(2.0f), true));
}

TEST(FrozenScanCheck, AcceptsRepeatedPointsUntilTheRobotHasMoved) {
  FrozenScanCheck check;
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(check.frozen(scan_from(1.0f), false));
  EXPECT_TRUE(check.frozen(scan_from(1.0f), true));
  EXPECT_TRUE(check.frozen(scan_from(1.0f), false)) << "the motion since the points began to repeat counts";
}

TEST(FrozenScanCheck, CountsTheRepetitionsThatEndedBeforeTheLastScan) {
  FrozenScanCheck check;
  for (int k = 0; k < 5; ++k) check.frozen(scan_from(1.0f), true);
  EXPECT_EQ(check.repeated_before(), 0);
  check.frozen(scan_from(2.0f), true);
  EXPECT_EQ(check.repeated_before(), 4);
  check.frozen(scan_from(3.0f), true);
  EXPECT_EQ(check.repeated_before(), 0);
}

TEST(FrozenScanCheck, AnotherNumberOfPointsOrNoPointsIsNoRepetition) {
  FrozenScanCheck check;
  check.frozen(scan_from(1.0f, 400), true);
  EXPECT_FALSE(check.frozen(scan_from(1.0f, 401), true));
  EXPECT_FALSE(check.frozen(scan_from(1.0f, 0), true));
  EXPECT_FALSE(check.frozen(scan_from(1.0f, 0), true));
}

}  // namespace
}  // namespace fleetmap::odometry
