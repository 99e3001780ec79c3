#include "fleetmap/localization/heading_alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fleetmap::localization {
namespace {

constexpr double kOffset = 2.2;  ///< rad, between the dead-reckoned and the true heading
const Eigen::Vector2d kFarOff(1e4, -1e4);

Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle) { return Eigen::Rotation2Dd(angle) * p; }

/// Drives `steps` metres on a curve of `curvature` (rad/m); fixes have no error but claim `sigma`.
HeadingAlignment driven(int steps, double curvature, double sigma, double direction = 1.0) {
  HeadingAlignment alignment;
  Eigen::Vector2d reckoned = Eigen::Vector2d::Zero();
  alignment.add_fix(turned(reckoned, kOffset) + kFarOff, sigma, Eigen::Vector2d::Zero());
  for (int k = 0; k < steps; ++k) {
    const double yaw = curvature * k;
    alignment.advance(direction, yaw);
    reckoned += direction * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    alignment.add_fix(turned(reckoned, kOffset) + kFarOff, sigma, Eigen::Vector2d::Zero());
  }
  return alignment;
}

TEST(HeadingAlignment, NothingIsKnownAtTheStart) {
  EXPECT_FALSE(HeadingAlignment().estimate());
  EXPECT_FALSE(driven(1, 0.0, 0.1).estimate());
}

TEST(HeadingAlignment, OffsetIsFoundOnStraightsCurvesAndInReverse) {
  for (const double curvature : {0.0, 0.05, -0.12}) {
    for (const double direction : {1.0, -1.0}) {
      // More matches than are kept.
      const auto estimate = driven(40, curvature, 0.1, direction).estimate();
      ASSERT_TRUE(estimate) << curvature;
      EXPECT_NEAR(std::remainder(estimate->yaw_offset - kOffset, 2.0 * std::numbers::pi), 0.0, 1e-6);
      EXPECT_GE(estimate->sigma, 0.03);  // dead reckoning bends
    }
  }
}

TEST(HeadingAlignment, TheSigmaGrowsWithTheErrorOfGpsAndShrinksWithTheTrack) {
  const auto sure = driven(40, 0.0, 0.1).estimate(), unsure = driven(40, 0.0, 2.0).estimate();
  const auto early = driven(10, 0.0, 2.0).estimate();
  ASSERT_TRUE(sure && unsure && early);
  EXPECT_GT(unsure->sigma, 2.0 * sure->sigma);
  EXPECT_GT(early->sigma, 1.5 * unsure->sigma);
}

TEST(HeadingAlignment, AStandingRobotHasNone) {
  HeadingAlignment alignment;
  EXPECT_TRUE(alignment.add_fix({0, 0}, 0.1, Eigen::Vector2d::Zero()));
  for (int k = 0; k < 50; ++k) EXPECT_FALSE(alignment.add_fix({0.1 * k, 0}, 0.1, Eigen::Vector2d::Zero()));
  EXPECT_FALSE(alignment.estimate());
}

TEST(HeadingAlignment, FixesCloserThanTheirErrorAreNotTaken) {
  HeadingAlignment alignment;
  alignment.add_fix({0, 0}, 8.0, Eigen::Vector2d::Zero());
  alignment.advance(3.9, 0.0);
  EXPECT_FALSE(alignment.add_fix({3.9, 0}, 8.0, Eigen::Vector2d::Zero()));
  alignment.advance(-0.2, 0.0);  // driving back counts as well
  EXPECT_TRUE(alignment.add_fix({3.7, 0}, 8.0, Eigen::Vector2d::Zero()));
}

TEST(HeadingAlignment, TracksThatDoNotFitGiveNoHeading) {
  HeadingAlignment alignment;
  for (int k = 0; k < 24; ++k) {
    // The wheels say straight ahead, GPS a circle.
    const double angle = 0.5 * k;
    alignment.add_fix({10.0 * std::cos(angle), 10.0 * std::sin(angle)}, 0.1, Eigen::Vector2d::Zero());
    alignment.advance(5.0, 0.0);
  }
  EXPECT_FALSE(alignment.estimate());
}

TEST(HeadingAlignment, TheAntennasOffsetIsTakenOut) {
  HeadingAlignment alignment;
  const double arm = -3.0;  // to the right, outside of the curve
  Eigen::Vector2d reckoned = Eigen::Vector2d::Zero();
  for (int k = 0; k < 24; ++k) {
    const double yaw = 0.3 * k;
    const Eigen::Vector2d offset = arm * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
    alignment.add_fix(turned(reckoned + offset, kOffset), 0.05, offset);
    alignment.advance(1.0, yaw);
    reckoned += Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
  }
  const auto estimate = alignment.estimate();
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(std::remainder(estimate->yaw_offset - kOffset, 2.0 * std::numbers::pi), 0.0, 1e-6);
}

TEST(HeadingAlignment, WithoutAnOdometerTheFixesAreTheTrack) {
  HeadingAlignment alignment;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  EXPECT_TRUE(alignment.add_fix_without_odometer(p, 0.1, 0.0));
  EXPECT_FALSE(alignment.add_fix_without_odometer({1.9, 0.0}, 0.1, 0.0));  // could be noise
  for (int k = 1; k < 20; ++k) {
    const double yaw = 0.1 * k;
    p += 3.0 * turned(Eigen::Vector2d(std::cos(yaw - 0.05), std::sin(yaw - 0.05)), kOffset);
    EXPECT_TRUE(alignment.add_fix_without_odometer(p, 0.1, yaw));
  }
  const auto estimate = alignment.estimate();
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(std::remainder(estimate->yaw_offset - kOffset, 2.0 * std::numbers::pi), 0.0, 1e-6);
}

TEST(HeadingAlignment, ClearForgetsTheTrack) {
  HeadingAlignment alignment = driven(40, 0.0, 0.1);
  ASSERT_TRUE(alignment.estimate());
  alignment.clear();
  EXPECT_FALSE(alignment.estimate());
}

}  // namespace
}  // namespace fleetmap::localization
