#include "fleetmap/sensor/clock_drift.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

constexpr double kBucket = 30.0;  // s

/// A sample a second over [begin, end); how many buckets they completed.
int feed(ClockDrift& drift, double begin, double end, const std::function<double(double)>& lag) {
  int completed = 0;
  for (double time = begin; time < end; time += 1.0) completed += drift.add(at(time), lag(time)) ? 1 : 0;
  return completed;
}

TEST(ClockDrift, HasALineAfterTenBuckets) {
  ClockDrift drift;
  EXPECT_FALSE(drift.first());
  EXPECT_EQ(feed(drift, 0.0, 300.0, [](double) { return 0.2; }), 9);
  EXPECT_FALSE(drift.line());
  EXPECT_TRUE(drift.add(at(300.0), 0.2));
  ASSERT_TRUE(drift.line());
  EXPECT_NEAR(drift.line()->slope, 0.0, 1e-15);
  EXPECT_NEAR(drift.line()->scatter, 0.0, 1e-12);
  EXPECT_NEAR(drift.line()->span, 9.0 * kBucket, 1e-6);
  EXPECT_EQ(drift.first(), 0.2);
  drift.reset();
  EXPECT_FALSE(drift.line());
  EXPECT_FALSE(drift.first());
}

TEST(ClockDrift, TheSlopeIsTheRateHoweverLateMostSamplesAre) {
  for (const double rate : {50e-6, -50e-6}) {
    ClockDrift drift;
    std::mt19937 random(1);
    std::exponential_distribution<double> late(2.0);
    // Every tenth sample is free of delay.
    int count = 0;
    feed(drift, 0.0, 1200.0,
         [&](double time) { return -3.0 + rate * time + (count++ % 10 == 0 ? 0.0 : 0.05 + late(random)); });
    ASSERT_TRUE(drift.line());
    EXPECT_NEAR(drift.line()->slope, rate, 1e-9);
    EXPECT_LT(drift.line()->scatter, 1e-9);
  }
}

TEST(ClockDrift, LineAndDeviationAreThoseOfLeastSquares) {
  constexpr int kBuckets = 14;
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 1e-3);
  Eigen::MatrixX2d A(kBuckets, 2);
  Eigen::VectorXd lags(kBuckets);
  ClockDrift drift;
  for (int k = 0; k <= kBuckets; ++k) {
    const double lag = 0.4 + 20e-6 * kBucket * k + noise(random);
    // The least comes first in its bucket.
    feed(drift, kBucket * k, kBucket * (k + 1), [&](double time) { return lag + (time > kBucket * k); });
    if (k == kBuckets) break;
    A.row(k) << 1.0, kBucket * k;
    lags(k) = lag;
  }
  const Eigen::Vector2d fit = A.colPivHouseholderQr().solve(lags);
  const double variance = (lags - A * fit).squaredNorm() / (kBuckets - 2);
  const Eigen::Matrix2d covariance = variance * (A.transpose() * A).inverse();
  const auto line = drift.line();
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->slope, fit(1), 1e-10);
  EXPECT_NEAR(line->deviation, std::sqrt(covariance(1, 1)), 1e-10);
  EXPECT_NEAR(line->scatter, std::sqrt(variance), 1e-9);
}

TEST(ClockDrift, LagsOlderThanHalfAnHourAreForgotten) {
  ClockDrift drift;
  // An hour without drift, then half an hour with.
  feed(drift, 0.0, 3600.0, [](double) { return 0.1; });
  const auto drifting = [](double time) { return 0.1 + 40e-6 * (time - 3600.0); };
  feed(drift, 3600.0, 3600.0 + kBucket * (ClockDrift::kMax - 1) + 1.0, drifting);
  EXPECT_LT(drift.line()->slope, 40e-6 - 1e-8) << "one bucket is of before";
  feed(drift, 3600.0 + kBucket * (ClockDrift::kMax - 1) + 1.0, 3600.0 + kBucket * ClockDrift::kMax + 1.0,
       drifting);
  EXPECT_NEAR(drift.line()->slope, 40e-6, 1e-10);
  EXPECT_NEAR(drift.line()->span, kBucket * (ClockDrift::kMax - 1), 1e-6);
  EXPECT_EQ(drift.first(), 0.1) << "of the first bucket since the reset";
}

TEST(ClockDrift, AGapMakesNoEmptyBucket) {
  ClockDrift drift;
  EXPECT_EQ(feed(drift, 0.0, 60.0, [](double) { return 0.1; }), 1);
  EXPECT_EQ(feed(drift, 5000.0, 5300.0, [](double) { return 0.1; }), 10);
  ASSERT_TRUE(drift.line());
  EXPECT_TRUE(std::isfinite(drift.line()->slope));
  EXPECT_NEAR(drift.line()->slope, 0.0, 1e-12);
}

}  // namespace
}  // namespace fleetmap::sensor
