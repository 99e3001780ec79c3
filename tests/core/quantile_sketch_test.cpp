#include "fleetmap/core/quantile_sketch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace fleetmap {
namespace {

/// As the sorted values have it.
double exact(std::vector<double> values, double q) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

TEST(QuantileSketch, HasTheQuantilesOfTheSortedValues) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> milliseconds(-4.0, 0.8);  // s: median 18 ms, a long tail
  QuantileSketch sketch;
  std::vector<double> values;
  for (int k = 0; k < 20'000; ++k) {
    values.push_back(milliseconds(random));
    sketch.add(values.back());
  }
  for (const double q : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0})
    EXPECT_NEAR(sketch.quantile(q) / exact(values, q), 1.0, QuantileSketch::kRelativeError * 1.0001) << q;
  EXPECT_EQ(sketch.count(), values.size());
  EXPECT_EQ(sketch.min(), *std::ranges::min_element(values));
  EXPECT_EQ(sketch.max(), *std::ranges::max_element(values));
  EXPECT_DOUBLE_EQ(sketch.mean(), std::accumulate(values.begin(), values.end(), 0.0) / 20'000);
}

TEST(QuantileSketch, TheOnlyLargeOfAHundredIsTheMaximumAndNotTheMedian) {
  QuantileSketch sketch;
  for (int k = 0; k < 99; ++k) sketch.add(0.010);
  sketch.add(1.0);
  EXPECT_NEAR(sketch.quantile(0.5), 0.010, 0.010 * QuantileSketch::kRelativeError);
  EXPECT_NEAR(sketch.quantile(0.98), 0.010, 0.010 * QuantileSketch::kRelativeError);
  EXPECT_EQ(sketch.quantile(1.0), 1.0);
}

TEST(QuantileSketch, ItsMemoryDoesNotGrowWithTheNumberOfValues) {
  QuantileSketch sketch;
  sketch.add(0.02);
  const std::size_t bins = sketch.bins();
  EXPECT_LT(bins, 2500u);  // 20 kB
  for (int k = 1; k <= 100'000; ++k) sketch.add(1e-9 * k * k);
  EXPECT_EQ(sketch.bins(), bins);
}

TEST(QuantileSketch, ValuesBeyondItsRangeCountAtItsEnds) {
  QuantileSketch sketch;
  for (const double value : {0.0, 1e-9, 0.5, 1e6, 1e7}) sketch.add(value);
  EXPECT_LE(sketch.quantile(0.25), QuantileSketch::kMin);
  EXPECT_NEAR(sketch.quantile(0.5), 0.5, 0.5 * QuantileSketch::kRelativeError);
  EXPECT_GE(sketch.quantile(0.75), QuantileSketch::kMax * (1.0 - QuantileSketch::kRelativeError));
  EXPECT_EQ(sketch.min(), 0.0);
  EXPECT_EQ(sketch.max(), 1e7);
}

TEST(QuantileSketch, WithoutValuesAllIsZero) {
  const QuantileSketch none;
  EXPECT_EQ(none.count(), 0u);
  EXPECT_EQ(none.mean(), 0.0);
  EXPECT_EQ(none.quantile(0.99), 0.0);
  EXPECT_EQ(none.max(), 0.0);
}

}  // namespace
}  // namespace fleetmap
