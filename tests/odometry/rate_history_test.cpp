#include "rate_history.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::odometry {
namespace {

using Eigen::Vector3d;
using std::chrono::milliseconds;

constexpr Duration kHold = milliseconds(100);

Stamp at(int ms) { return Stamp{std::chrono::seconds(50)} + milliseconds(ms); }

/// Samples each 100 ms from 0 to `until` ms; the rate about z grows by 1 a second.
RateHistory ramp(int until) {
  RateHistory history;
  for (int ms = 0; ms <= until; ms += 100) history.add(at(ms), {2.0, 0.0, 0.001 * ms});
  return history;
}

TEST(RateHistory, TheMeanIsThatOfTheLinesBetweenTheSamples) {
  const RateHistory history = ramp(1000);
  for (const auto& [from, to] :
       std::vector<std::pair<int, int>>{{0, 1000}, {130, 170}, {150, 850}, {0, 50}}) {
    const auto mean = history.mean(at(from), at(to), kHold);
    ASSERT_TRUE(mean) << from;
    EXPECT_LT((*mean - Vector3d(2.0, 0.0, 0.0005 * (from + to))).norm(), 1e-12) << from;
  }
  EXPECT_NEAR(history.mean(at(250), at(250), kHold)->z(), 0.25, 1e-12) << "at an instant it is the rate";
}

/// A peak between the ends counts by its area: the mean is no mean of samples or of ends.
TEST(RateHistory, TheMeanWeighsSamplesByTheirTime) {
  RateHistory history;
  history.add(at(0), {0, 0, 0});
  history.add(at(100), {4, 0, 0});
  history.add(at(400), {0, 0, 0});
  EXPECT_NEAR(history.mean(at(0), at(400), kHold)->x(), 2.0, 1e-12);
  EXPECT_NEAR(history.mean(at(50), at(250), kHold)->x(), (0.05 * 3.0 + 0.15 * 3.0) / 0.2, 1e-12);
}

TEST(RateHistory, TheOutermostSamplesAreHeldForAWhile) {
  const RateHistory history = ramp(1000);
  const auto mean = history.mean(at(1000), at(1100), kHold);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(mean->z(), 1.0, 1e-12);
  EXPECT_NEAR(history.mean(at(900), at(1100), kHold)->z(), (0.95 + 1.0) / 2.0, 1e-12);
  EXPECT_NEAR(history.mean(at(-100), at(0), kHold)->z(), 0.0, 1e-12);
  EXPECT_FALSE(history.mean(at(900), at(1101), kHold));
  EXPECT_FALSE(history.mean(at(-101), at(500), kHold));
  EXPECT_FALSE(history.rotation(at(900), at(1101), Vector3d::Zero(), kHold));
  EXPECT_FALSE(RateHistory().mean(at(0), at(0), kHold));
}

TEST(RateHistory, AGapInItIsNotBridged) {
  RateHistory history = ramp(200);
  history.add(at(701), {0, 0, 0});
  EXPECT_FALSE(history.mean(at(100), at(701), kHold));
  EXPECT_FALSE(history.rotation(at(100), at(701), Vector3d::Zero(), kHold));
  EXPECT_TRUE(history.mean(at(0), at(200), kHold)) << "before it all is known";
  RateHistory shorter = ramp(200);
  shorter.add(at(700), {0, 0, 0});
  EXPECT_TRUE(shorter.mean(at(100), at(700), kHold));
}

TEST(RateHistory, BadSamplesAreRefused) {
  RateHistory history = ramp(300);
  EXPECT_FALSE(history.add(at(400), {0, std::numeric_limits<double>::quiet_NaN(), 0}));
  EXPECT_FALSE(history.add(at(400), {0, 0, std::numeric_limits<double>::infinity()}));
  EXPECT_FALSE(history.add(at(300), {9, 9, 9})) << "the same time again";
  EXPECT_FALSE(history.add(at(200), {9, 9, 9}));
  EXPECT_FALSE(history.add(at(-699), {9, 9, 9})) << "less than a second ago";
  EXPECT_EQ(history.size(), 4u);
  EXPECT_NEAR(history.mean(at(0), at(300), kHold)->x(), 2.0, 1e-12);
}

TEST(RateHistory, AClockThatWasSetBackBeginsItAnew) {
  RateHistory history = ramp(300);
  EXPECT_TRUE(history.add(at(-700), {5, 0, 0}));
  EXPECT_EQ(history.size(), 1u);
  EXPECT_NEAR(history.mean(at(-700), at(-650), kHold)->x(), 5.0, 1e-12);
  EXPECT_FALSE(history.mean(at(0), at(100), kHold)) << "what was before is forgotten";
}

TEST(RateHistory, IsBounded) {
  RateHistory history;
  for (int ms = 0; ms < 100'000; ++ms) history.add(at(ms), {1, 2, 3});
  EXPECT_LT(history.size(), 10'000u);
  EXPECT_TRUE(history.mean(at(95'000), at(99'999), kHold)) << "the last ones are kept";
}

TEST(RateHistory, TheRotationIsTheIntegralOfTheRateLessItsBias) {
  RateHistory about_z;
  for (int ms = 0; ms <= 1000; ms += 100) about_z.add(at(ms), {0, 0, 0.001 * ms + 0.3});
  const auto R = about_z.rotation(at(200), at(750), {0, 0, 0.3}, kHold);
  ASSERT_TRUE(R);
  EXPECT_LT((so3_log(*R) - Vector3d(0, 0, 0.5 * (0.75 * 0.75 - 0.2 * 0.2))).norm(), 1e-12);
  EXPECT_LT(
      (*about_z.rotation(at(300), at(300), Vector3d::Zero(), kHold) - Eigen::Matrix3d::Identity()).norm(),
      1e-15);
}

/// About axes that change, turns do not commute: the later one is in the frame of the earlier one.
TEST(RateHistory, RotationsOfPiecesMakeThatOfTheWhole) {
  RateHistory history;
  for (int ms = 0; ms <= 1000; ms += 100)
    history.add(at(ms), ms < 500 ? Vector3d(3, 0, 0) : Vector3d(0, 0, 3));
  const auto R = [&](int from, int to) {
    return *history.rotation(at(from), at(to), Vector3d::Zero(), kHold);
  };
  EXPECT_LT((R(0, 1000) - R(0, 400) * R(400, 500) * R(500, 1000)).norm(), 1e-12);
  EXPECT_LT((R(0, 400) - so3_exp({1.2, 0, 0})).norm(), 1e-12);
  EXPECT_LT((R(500, 1000) - so3_exp({0, 0, 1.5})).norm(), 1e-12);
  EXPECT_GT((R(0, 1000) - R(500, 1000) * R(400, 500) * R(0, 400)).norm(), 0.5);
}

TEST(RateHistory, TheTrendOfALineIsItsSlopeWithoutVariance) {
  const RateHistory history = ramp(1000);
  const auto trend = history.trend(at(200), at(600));
  ASSERT_TRUE(trend);
  EXPECT_LT((trend->slope - Vector3d(0, 0, 1.0)).norm(), 1e-9);
  EXPECT_LT(trend->variance.norm(), 1e-12);
  EXPECT_FALSE(history.trend(at(201), at(600))) << "four samples are too few";
}

TEST(RateHistory, AGapInWhichTheIntervalBeginsIsNotBridged) {
  RateHistory history = ramp(200);
  history.add(at(2000), {0, 0, 0});
  EXPECT_FALSE(history.mean(at(900), at(1000), kHold));
  EXPECT_FALSE(history.mean(at(900), at(2050), kHold));
  EXPECT_FALSE(history.rotation(at(900), at(1000), Vector3d::Zero(), kHold));
  EXPECT_FALSE(history.mean(at(150), at(1000), kHold));
  EXPECT_TRUE(history.mean(at(110), at(190), kHold));
}

}  // namespace
}  // namespace fleetmap::odometry
