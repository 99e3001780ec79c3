#include "fleetmap/sensor/running_integral.hpp"

#include <gtest/gtest.h>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

TEST(RunningIntegral, OfALinearRateIsExactBetweenSamples) {
  RunningIntegral integral;
  for (int k = 0; k <= 20; ++k) integral.add(at(0.1 * k), {0.1 * k, 1.0, 0.0});
  const auto sum = integral.between(at(0.5), at(1.5));
  ASSERT_TRUE(sum);
  EXPECT_NEAR(sum->x(), 0.5 * (1.5 * 1.5 - 0.5 * 0.5), 1e-9);
  EXPECT_NEAR(sum->y(), 1.0, 1e-9);
  EXPECT_EQ(integral.last(), at(2.0));
  EXPECT_TRUE(integral.between(at(0.0), at(2.0)));
  EXPECT_FALSE(integral.between(at(-0.1), at(1.0)));
  EXPECT_FALSE(integral.between(at(1.0), at(2.1)));
}

TEST(RunningIntegral, AGapBeginsAnewAndTheOldIsForgotten) {
  RunningIntegral integral;
  for (int k = 0; k <= 10; ++k) integral.add(at(0.1 * k), {1.0, 0.0, 0.0});
  for (int k = 0; k <= 50; ++k) integral.add(at(2.0 + 0.1 * k), {1.0, 0.0, 0.0});
  EXPECT_FALSE(integral.between(at(0.5), at(2.5)));
  EXPECT_FALSE(integral.between(at(3.0), at(4.5))) << "more than 3 s ago";
  EXPECT_NEAR(integral.between(at(5.0), at(6.0))->x(), 1.0, 1e-9);
}

}  // namespace
}  // namespace fleetmap::sensor
