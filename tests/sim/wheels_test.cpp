#include "fleetmap/sim/wheels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "sim/stamps.hpp"

namespace fleetmap::sim {
namespace {

WheelSpec perfect_wheels() {
  WheelSpec spec;
  spec.scale_sigma = spec.yaw_scale_sigma = spec.slip = spec.slip_turning = 0.0;
  spec.speed_noise = spec.yaw_rate_noise = 0.0;
  return spec;
}

/// Root of the mean of `square` over many robots.
double rms(const std::function<double(std::uint64_t seed)>& deviation) {
  constexpr std::uint64_t kRobots = 3000;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kRobots; ++seed) sum += std::pow(deviation(seed), 2) / kRobots;
  return std::sqrt(sum);
}

TEST(WheelModel, PerfectWheelsTellTheTruth) {
  WheelModel wheels(perfect_wheels(), 1);
  const sensor::Wheel sample = wheels.measure(at(2.5), -1.5, 0.7);
  EXPECT_EQ(sample.stamp, at(2.5));
  EXPECT_DOUBLE_EQ(sample.forward_speed, -1.5);
  EXPECT_DOUBLE_EQ(sample.yaw_rate.value(), 0.7);
}

TEST(WheelModel, NoiseIsThereAlsoAtRest) {
  WheelSpec spec = perfect_wheels();
  spec.speed_noise = 0.05;
  spec.yaw_rate_noise = 0.2;
  EXPECT_NEAR(
      rms([&](std::uint64_t seed) { return WheelModel(spec, seed).measure(at(0), 0, 0).forward_speed; }),
      0.05, 0.003);
  EXPECT_NEAR(rms([&](std::uint64_t seed) { return *WheelModel(spec, seed).measure(at(0), 0, 0).yaw_rate; }),
              0.2, 0.012);
}

TEST(WheelModel, YawRateHasAScaleAndASlipOfItsOwn) {
  WheelSpec spec = perfect_wheels();
  spec.yaw_scale_sigma = 0.05;
  EXPECT_NEAR(
      rms([&](std::uint64_t seed) { return *WheelModel(spec, seed).measure(at(0), 1, 2).yaw_rate - 2.0; }),
      0.1, 0.006);
  EXPECT_DOUBLE_EQ(WheelModel(spec, 1).measure(at(0), 1, 2).forward_speed, 1.0);
  spec = perfect_wheels();
  spec.slip = 0.01;
  spec.slip_turning = 0.1;  // 0.01 + 2 * 0.1 at 2 rad/s
  EXPECT_NEAR(
      rms([&](std::uint64_t seed) { return *WheelModel(spec, seed).measure(at(0), 1, -2).yaw_rate + 2.0; }),
      0.42, 0.025);
  EXPECT_NEAR(
      rms([&](std::uint64_t seed) { return WheelModel(spec, seed).measure(at(0), 1, -2).forward_speed - 1; }),
      0.21, 0.0125);
}

TEST(WheelModel, ASlipLastsItsTime) {
  WheelSpec spec = perfect_wheels();
  spec.slip = 0.1;
  spec.slip_time = 0.5;
  spec.rate = 20.0;
  double product = 0.0;
  constexpr int kRobots = 4000;
  for (std::uint64_t seed = 0; seed < kRobots; ++seed) {
    WheelModel wheels(spec, seed);
    const double first = wheels.measure(at(0), 1, 0).forward_speed - 1.0;
    double last = 0.0;
    for (int k = 1; k <= 10; ++k) last = wheels.measure(at(0.05 * k), 1, 0).forward_speed - 1.0;
    product += first * last / 0.01 / kRobots;
  }
  EXPECT_NEAR(product, std::exp(-1.0), 0.07) << "0.5 s later";
}

TEST(WheelModel, SameSeedSameWheels) {
  WheelModel first(WheelSpec{}, 4), second(WheelSpec{}, 4), other(WheelSpec{}, 5);
  for (int k = 0; k < 20; ++k) {
    const double speed = first.measure(at(0.05 * k), 1, 0.3).forward_speed;
    EXPECT_EQ(speed, second.measure(at(0.05 * k), 1, 0.3).forward_speed);
    EXPECT_NE(speed, other.measure(at(0.05 * k), 1, 0.3).forward_speed);
  }
}

}  // namespace
}  // namespace fleetmap::sim
