#include "sim/gaussian.hpp"

#include <gtest/gtest.h>

namespace fleetmap::sim {
namespace {

constexpr int kMany = 40'000;

struct Moments {
  double mean = 0.0, variance = 0.0, beyond_two = 0.0;
};
template <class Draw>
Moments moments(Draw&& draw) {
  Moments m;
  for (int k = 0; k < kMany; ++k) {
    const double value = static_cast<double>(draw());
    m.mean += value / kMany;
    m.variance += value * value / kMany;
    m.beyond_two += (std::abs(value) > 2.0 ? 1.0 : 0.0) / kMany;
  }
  return m;
}
void expect_standard_normal(const Moments& m) {
  EXPECT_NEAR(m.mean, 0.0, 0.02);
  EXPECT_NEAR(m.variance, 1.0, 0.03);
  EXPECT_NEAR(m.beyond_two, 0.0455, 0.0042);
}

TEST(Gaussian, IsStandardNormalInBothPrecisions) {
  std::uint64_t counter = 0;
  expect_standard_normal(moments([&] { return gaussian(mixed(counter++)); }));
  expect_standard_normal(moments([&] { return gaussian_float(mixed(counter++)); }));
  RandomStream stream(1, 2);
  expect_standard_normal(moments([&] { return stream.normal(); }));
}

TEST(Gaussian, IsFiniteForAnyBits) {
  for (const std::uint64_t bits :
       {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{0xffffffff}, std::uint64_t{0xffffffff} << 32}) {
    EXPECT_TRUE(std::isfinite(gaussian(bits))) << bits;
    EXPECT_TRUE(std::isfinite(gaussian_float(bits))) << bits;
  }
  // u = 2^-33 and v = 0.
  EXPECT_NEAR(gaussian(0), std::sqrt(2.0 * 33.0 * std::log(2.0)), 1e-12);
  EXPECT_NEAR(gaussian(0x80000000), -gaussian(0), 1e-12) << "half a turn on";
}

TEST(Uniform16, TakesOneOfFourParts) {
  const std::uint64_t bits = 0xffff'8000'4000'0001;
  EXPECT_EQ(uniform16(bits, 0), 0x1p-16f);
  EXPECT_EQ(uniform16(bits, 1), 0.25f);
  EXPECT_EQ(uniform16(bits, 2), 0.5f);
  EXPECT_EQ(uniform16(bits, 3), 1.0f - 0x1p-16f);
}

TEST(RandomStream, FollowsFromSeedAndSource) {
  RandomStream a(1, 2), same(1, 2), source(1, 3), seed(2, 2);
  double sum = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double value = a.uniform();
    EXPECT_EQ(value, same.uniform());
    EXPECT_NE(value, source.uniform());
    EXPECT_NE(value, seed.uniform());
    EXPECT_GE(value, 0.0);
    EXPECT_LT(value, 1.0);
    sum += value / 1000;
  }
  EXPECT_NEAR(sum, 0.5, 0.04);
}

TEST(GaussMarkov, HasItsSigmaAtOnceAndItsCorrelationAfterAnyStep) {
  for (const double dt : {0.1, 2.0, 10.0}) {
    double first_squares = 0.0, squares = 0.0, products = 0.0;
    for (int k = 0; k < kMany; ++k) {
      RandomStream random(static_cast<std::uint64_t>(k), 7);
      GaussMarkov process(3.0, 2.0);
      const double first = process.next(dt, random), second = process.next(dt, random);
      first_squares += first * first / kMany;
      squares += second * second / kMany;
      products += first * second / kMany;
    }
    EXPECT_NEAR(first_squares, 9.0, 0.3) << dt;
    EXPECT_NEAR(squares, 9.0, 0.3) << dt;
    EXPECT_NEAR(products / 9.0, std::exp(-dt / 2.0), 0.035) << dt;
  }
}

TEST(GaussMarkov, OfNoSigmaIsZero) {
  RandomStream random(1, 1);
  GaussMarkov process(0.0, 60.0);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(process.next(0.1, random), 0.0);
}

}  // namespace
}  // namespace fleetmap::sim
