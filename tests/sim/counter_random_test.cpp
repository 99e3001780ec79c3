#include "sim/counter_random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace fleetmap::sim {
namespace {

/// The first outputs of the reference implementation of SplitMix64 (Steele, Lea and Flood 2014) with seed 0.
TEST(CounterRandom, MixesAsSplitMix64) {
  EXPECT_EQ(mixed(0), 0xE220A8397B1DCDAFULL);
  EXPECT_EQ(mixed(0x9E3779B97F4A7C15ULL), 0x6E789E6AA1B965F4ULL);
}

TEST(CounterRandom, DependsOnItsArgumentsAlone) {
  const double value = uniform_at(1, 2, 3, 4);
  uniform_at(5, 6);
  EXPECT_EQ(uniform_at(1, 2, 3, 4), value);
  EXPECT_EQ(uniform_at(1, 2), uniform_at(1, 2, 0, 0));
}

TEST(CounterRandom, EveryArgumentChangesTheValue) {
  const std::set<double> values{uniform_at(1, 2, 3, 4), uniform_at(2, 2, 3, 4), uniform_at(1, 3, 3, 4),
                                uniform_at(1, 2, 4, 4), uniform_at(1, 2, 3, 5), uniform_at(2, 1, 3, 4)};
  EXPECT_EQ(values.size(), 6u);
}

TEST(CounterRandom, IsUniform) {
  constexpr int kCount = 100'000;
  double sum = 0.0, squares = 0.0, neighbours = 0.0, last = 0.0;
  for (int k = 0; k < kCount; ++k) {
    const double value = uniform_at(7, static_cast<std::uint64_t>(k));
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    const double centred = value - 0.5;
    sum += centred;
    squares += centred * centred;
    neighbours += centred * last;
    last = centred;
  }
  // Five standard deviations of each mean.
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 * std::sqrt(1.0 / 12.0 / kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 12.0, 5.0 * std::sqrt(1.0 / 180.0 / kCount));
  EXPECT_NEAR(neighbours / kCount, 0.0, 5.0 / 12.0 / std::sqrt(kCount));
}

TEST(CounterRandom, SignedNumbersCoverBothSigns) {
  for (std::uint64_t k = 0; k < 1000; ++k) {
    EXPECT_EQ(signed_at(3, k), 2.0 * uniform_at(3, k) - 1.0);
    EXPECT_LT(std::abs(signed_at(3, k)), 1.0 + 1e-15);
  }
}

}  // namespace
}  // namespace fleetmap::sim
