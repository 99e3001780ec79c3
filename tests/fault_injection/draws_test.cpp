#include "draws.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace fleetmap::fault_injection {
namespace {

constexpr int kDraws = 40'000;

TEST(Draws, AreThoseOfSplitMix64OnEveryMachine) {
  Draws draws(1, 2), zero(0, 0);
  for (const std::uint64_t bits : {5196188657185181188u, 5005007431957806747u, 13825384577461178096u})
    EXPECT_EQ(draws.bits(), bits);
  for (const std::uint64_t bits : {6235967106033911276u, 4964577235801436555u, 5009519748041543987u})
    EXPECT_EQ(zero.bits(), bits);
}

TEST(Draws, StreamsOfOneSeedHaveNothingInCommon) {
  Draws a(7, 1), b(7, 2);
  double product = 0.0;
  for (int k = 0; k < kDraws; ++k) product += (a.uniform() - 0.5) * (b.uniform() - 0.5) / kDraws;
  EXPECT_NEAR(product, 0.0, 4.0 / 12.0 / std::sqrt(kDraws));
}

TEST(Draws, AreEvenWithinTheirBounds) {
  Draws draws(3, 0);
  std::array<int, 10> tenths{};
  for (int k = 0; k < kDraws; ++k) {
    const double value = draws.between(-1.0, 4.0);
    ASSERT_GE(value, -1.0);
    ASSERT_LT(value, 4.0);
    ++tenths.at(static_cast<std::size_t>(2.0 * (value + 1.0)));
  }
  for (const int count : tenths) EXPECT_NEAR(count, kDraws / 10, 240);  // 4 sigma
}

TEST(Draws, BelowANumberReachAllThatAreLessAndNoneForZero) {
  Draws draws(4, 0);
  std::array<int, 7> counts{};
  for (int k = 0; k < 7'000; ++k) ++counts.at(draws.below(7));
  EXPECT_THAT(counts, ::testing::Each(::testing::AllOf(::testing::Gt(870), ::testing::Lt(1130))));
  EXPECT_EQ(draws.below(0), 0u);
  EXPECT_EQ(draws.below(1), 0u);
}

TEST(Draws, AChanceIsTheShareOfCasesInWhichItIsTrue) {
  Draws draws(5, 0);
  int hits = 0;
  for (int k = 0; k < kDraws; ++k) {
    EXPECT_FALSE(draws.chance(0.0));
    EXPECT_TRUE(draws.chance(1.0));
    hits += draws.chance(0.2);
  }
  EXPECT_NEAR(hits, 0.2 * kDraws, 320);
}

TEST(Draws, NormalOnesHaveSigmaOneAndTheTailsOfTheirLaw) {
  Draws draws(6, 0);
  double sum = 0.0, squares = 0.0;
  int beyond_two = 0;
  for (int k = 0; k < kDraws; ++k) {
    const double value = draws.normal();
    sum += value / kDraws;
    squares += value * value / kDraws;
    beyond_two += std::abs(value) > 2.0;
  }
  EXPECT_NEAR(sum, 0.0, 0.02);
  EXPECT_NEAR(squares, 1.0, 0.03);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, 0.0455, 0.0042);
}

}  // namespace
}  // namespace fleetmap::fault_injection
