#include "fleetmap/geometry/portable_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <random>

namespace fleetmap::portable {
namespace {

/// In units of the last digit of `right`.
double error(double value, double right) {
  return std::abs(value - right) / (std::nextafter(std::abs(right), INFINITY) - std::abs(right));
}

/// Numbers that every processor draws alike.
class Numbers {
 public:
  double next(double reach) {
    return reach * (2.0 * std::ldexp(static_cast<double>(random_() >> 11), -53) - 1.0);
  }

 private:
  std::mt19937_64 random_{1};
};

TEST(PortableMath, IsAsExactAsTheLibraryOfC) {
  Numbers numbers;
  for (int k = 0; k < 20000; ++k) {
    const double x = numbers.next(k % 2 == 0 ? 7.0 : 1e-3), y = numbers.next(3.0), unit = numbers.next(1.0);
    EXPECT_LE(error(sin_cos(x).sin, std::sin(x)), 1.0) << x;
    EXPECT_LE(error(sin_cos(x).cos, std::cos(x)), 1.0) << x;
    EXPECT_LE(error(tan(x), std::tan(x)), 1.0) << x;
    EXPECT_LE(error(asin(unit), std::asin(unit)), 1.0) << unit;
    EXPECT_LE(error(atan2(x, y), std::atan2(x, y)), 1.0) << x << ' ' << y;
    EXPECT_LE(error(exp(x), std::exp(x)), 1.0) << x;
    EXPECT_LE(error(exp2(x), std::exp2(x)), 1.0) << x;
    EXPECT_LE(error(log2(std::abs(x)), std::log2(std::abs(x))), 1.0) << x;
    EXPECT_LE(error(log(std::abs(x)), std::log(std::abs(x))), 1.0) << x;
  }
}

TEST(PortableMath, KnowsTheQuadrantsAndWhatIsNoNumber) {
  EXPECT_EQ(atan2(0.0, -1.0), std::atan2(0.0, -1.0));
  EXPECT_EQ(atan2(-1.0, 0.0), std::atan2(-1.0, 0.0));
  EXPECT_EQ(atan2(0.0, 0.0), 0.0);
  EXPECT_TRUE(std::isnan(sin_cos(std::numeric_limits<double>::infinity()).sin));
  EXPECT_TRUE(std::isnan(asin(1.5)));
  EXPECT_TRUE(std::isnan(log(-1.0)));
  EXPECT_EQ(log(0.0), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(exp(-std::numeric_limits<double>::infinity()), 0.0);
}

TEST(PortableMath, GivesTheseBitsOnEveryProcessor) {
  Numbers numbers;
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a over whole numbers
  for (int k = 0; k < 20000; ++k) {
    const double x = numbers.next(k % 2 == 0 ? 7.0 : 1e-3), y = numbers.next(3.0), unit = numbers.next(1.0);
    const auto [sin, cos] = sin_cos(x);
    for (const double value :
         {sin, cos, tan(x), asin(unit), atan2(x, y), exp(x), exp2(x), log(std::abs(x)), log2(std::abs(x))})
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211u;
  }
  EXPECT_EQ(hash, 16260904262625642049u);
}

}  // namespace
}  // namespace fleetmap::portable
