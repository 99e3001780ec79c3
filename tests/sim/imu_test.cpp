#include "fleetmap/sim/imu.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/perfect_imu.hpp"
#include "sim/stamps.hpp"

namespace fleetmap::sim {
namespace {

ImuMotion motion(double t, const Eigen::Matrix3d& R, const Eigen::Vector3d& velocity = {0, 0, 0}) {
  return {at(t), make_pose(R, {1, 2, 3}), velocity};
}

TEST(ImuModel, AtRestItFeelsGravityInItsOwnFrame) {
  ImuSpec spec = perfect_imu();
  spec.gravity = 10.0;
  const Eigen::Matrix3d R = rotation_from_rpy(0.3, -0.2, 1.1);
  const sensor::Imu sample = ImuModel(spec, 1).measure(motion(1.0, R), motion(1.01, R));
  EXPECT_EQ(sample.stamp, at(1.01));
  EXPECT_LT(sample.angular_velocity.norm(), 1e-9);
  EXPECT_LT((sample.specific_force - 10.0 * R.row(2).transpose()).norm(), 1e-9) << "up, as the IMU has it";
  ASSERT_TRUE(sample.q_enu_imu);
  EXPECT_LT((sample.q_enu_imu->toRotationMatrix() - R).norm(), 1e-9);
}

TEST(ImuModel, ASampleIsTheMeanOverItsInterval) {
  const Eigen::Matrix3d before = rotation_from_rpy(0.0, 0.0, 0.5), now = rotation_from_rpy(0.0, 0.0, 0.7);
  const sensor::Imu sample =
      ImuModel(perfect_imu(), 1).measure(motion(0.0, before, {1, 0, 0}), motion(0.1, now, {1, 0.5, 0}));
  EXPECT_LT((sample.angular_velocity - Eigen::Vector3d(0, 0, 2.0)).norm(), 1e-9);
  // 5 m/s^2 to the north, seen from half of the turn.
  const Eigen::Vector3d force(5.0 * std::sin(0.6), 5.0 * std::cos(0.6), 9.80665);
  EXPECT_LT((sample.specific_force - force).norm(), 1e-9);
}

/// Root mean square of a sample's deviation over many devices, per axis: gyro and accelerometer.
std::pair<double, double> deviation(const ImuSpec& spec, double dt, int samples) {
  constexpr int kDevices = 1000;
  double gyro = 0.0, accel = 0.0;
  for (std::uint64_t seed = 0; seed < kDevices; ++seed) {
    ImuModel imu(spec, seed);
    sensor::Imu last;
    for (int k = 0; k < samples; ++k)
      last = imu.measure(motion(k * dt, Eigen::Matrix3d::Identity()),
                         motion((k + 1) * dt, Eigen::Matrix3d::Identity()));
    gyro += last.angular_velocity.squaredNorm() / 3.0 / kDevices;
    accel += (last.specific_force - Eigen::Vector3d(0, 0, 9.80665)).squaredNorm() / 3.0 / kDevices;
  }
  return {std::sqrt(gyro), std::sqrt(accel)};
}

TEST(ImuModel, NoiseShrinksWithTheRootOfTheInterval) {
  ImuSpec spec = perfect_imu();
  spec.gyro_noise = 2e-3;
  spec.accel_noise = 3e-2;
  for (const double dt : {0.01, 0.04}) {
    const auto [gyro, accel] = deviation(spec, dt, 1);
    EXPECT_NEAR(gyro / (2e-3 / std::sqrt(dt)), 1.0, 0.06) << dt;
    EXPECT_NEAR(accel / (3e-2 / std::sqrt(dt)), 1.0, 0.06) << dt;
  }
}

TEST(ImuModel, BiasesWalkWithTheRootOfTime) {
  ImuSpec spec = perfect_imu();
  spec.gyro_bias_walk = 1e-3;
  spec.accel_bias_walk = 2e-2;
  for (const int samples : {1, 16}) {
    const auto [gyro, accel] = deviation(spec, 0.25, samples);
    EXPECT_NEAR(gyro / (1e-3 * std::sqrt(0.25 * samples)), 1.0, 0.06) << samples;
    EXPECT_NEAR(accel / (2e-2 * std::sqrt(0.25 * samples)), 1.0, 0.06) << samples;
  }
}

TEST(ImuModel, OrientationIsOptionalAndStatesItsVariances) {
  ImuSpec spec = perfect_imu();
  spec.tilt_sigma = 0.02;
  spec.heading_sigma = 0.3;
  const ImuMotion before = motion(0.0, Eigen::Matrix3d::Identity()),
                  now = motion(0.01, Eigen::Matrix3d::Identity());
  double tilt = 0.0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const sensor::Imu sample = ImuModel(spec, seed).measure(before, now);
    EXPECT_TRUE(sample.orientation_variance.isApprox(Eigen::Vector3d(4e-4, 4e-4, 0.09), 1e-12));
    tilt += std::pow(std::acos(std::min(1.0, sample.q_enu_imu->toRotationMatrix()(2, 2))), 2) / 1000;
  }
  EXPECT_NEAR(std::sqrt(tilt), 0.02 * std::sqrt(2.0), 0.002) << "about two axes";
  spec.reports_orientation = false;
  EXPECT_FALSE(ImuModel(spec, 1).measure(before, now).q_enu_imu);
}

TEST(ImuModel, SameSeedSameSamples) {
  ImuModel first(ImuSpec{}, 8), second(ImuSpec{}, 8), other(ImuSpec{}, 9);
  const auto next = [k = 0](ImuModel& imu) mutable {
    ++k;
    return imu
        .measure(motion(0.01 * k, Eigen::Matrix3d::Identity()),
                 motion(0.01 * (k + 1), Eigen::Matrix3d::Identity()))
        .angular_velocity;
  };
  auto a = next, b = next, c = next;
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d omega = a(first);
    EXPECT_EQ(omega, b(second));
    EXPECT_NE(omega, c(other));
  }
}

}  // namespace
}  // namespace fleetmap::sim
