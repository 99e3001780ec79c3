#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fleetmap/sim/gps.hpp"
#include "fleetmap/sim/imu.hpp"
#include "fleetmap/sim/wheels.hpp"
#include "sim/perfect_imu.hpp"
#include "sim/stamps.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

/// A bend with sway: position, attitude and velocity.
ImuMotion swaying_motion(double t) {
  ImuMotion m;
  m.stamp = at(t);
  m.T_enu_imu = make_pose(rotation_from_rpy(0.05 * std::sin(2 * t), 0.04 * std::cos(3 * t), 0.3 * t),
                          {5.0 * std::sin(0.3 * t), 5.0 - 5.0 * std::cos(0.3 * t), 0.1 * std::sin(t)});
  m.velocity_enu = {1.5 * std::cos(0.3 * t), 1.5 * std::sin(0.3 * t), 0.1 * std::cos(t)};
  return m;
}

TEST(Imu, WithoutNoiseIntegratesToTheTruth) {
  ImuModel imu(perfect_imu(), 1);
  Eigen::Matrix3d R = swaying_motion(0).T_enu_imu.linear();
  Eigen::Vector3d v = swaying_motion(0).velocity_enu, p = swaying_motion(0).T_enu_imu.translation();
  for (int k = 1; k <= 2000; ++k) {
    const sensor::Imu sample = imu.measure(swaying_motion(0.01 * (k - 1)), swaying_motion(0.01 * k));
    const Eigen::Matrix3d R_middle = R * so3_exp(0.005 * sample.angular_velocity);
    const Eigen::Vector3d a = R_middle * sample.specific_force - Eigen::Vector3d(0, 0, 9.80665);
    p += 0.01 * v + 5e-5 * a;
    v += 0.01 * a;
    R = R * so3_exp(0.01 * sample.angular_velocity);
    ASSERT_TRUE(sample.q_enu_imu);
    EXPECT_LT(so3_log(sample.q_enu_imu->toRotationMatrix().transpose() * R).norm(), 1e-6);
  }
  EXPECT_LT((v - swaying_motion(20).velocity_enu).norm(), 1e-6);
  EXPECT_LT((p - swaying_motion(20).T_enu_imu.translation()).norm(), 5e-3);
}

TEST(Imu, NoiseAndBiasHaveTheirDensities) {
  ImuSpec spec = perfect_imu();
  spec.gyro_noise = 2e-3;
  spec.accel_bias_sigma = 0.05;
  double square = 0.0, bias_square = 0.0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    ImuModel imu(spec, seed);
    Eigen::Vector3d turned = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero();
    ImuMotion rest;
    for (int k = 1; k <= 100; ++k) {
      ImuMotion next = rest;
      next.stamp = at(0.01 * k);
      const sensor::Imu sample = imu.measure(rest, next);
      turned += 0.01 * sample.angular_velocity;
      force += 0.01 * sample.specific_force;
      rest = next;
    }
    square += turned.squaredNorm() / 3.0;
    bias_square += (force - Eigen::Vector3d(0, 0, 9.80665)).squaredNorm() / 3.0;
  }
  EXPECT_NEAR(std::sqrt(square / 300), 2e-3, 2e-4);  // after one second
  EXPECT_NEAR(std::sqrt(bias_square / 300), 0.05, 0.005);
}

TEST(Imu, HeadingErrorDriftsSlowlyAndIsReported) {
  ImuSpec spec = perfect_imu();
  spec.heading_sigma = 0.1;
  double square = 0.0, step = 0.0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    ImuModel imu(spec, seed);
    ImuMotion rest, next;
    next.stamp = at(0.01);
    const auto heading = [&] {
      const sensor::Imu sample = imu.measure(rest, next);
      EXPECT_DOUBLE_EQ(sample.orientation_variance.z(), 0.01);
      return so3_log(sample.q_enu_imu->toRotationMatrix()).z();
    };
    const double first = heading();
    square += first * first;
    step = std::max(step, std::abs(heading() - first));
  }
  EXPECT_NEAR(std::sqrt(square / 400), 0.1, 0.01);
  EXPECT_LT(step, 0.01);
}

struct GpsErrors {
  std::vector<Eigen::Vector3d> errors;
  std::vector<sensor::Fix> fixes;
};

GpsErrors gps_errors(const GpsSpec& spec, std::uint64_t seed, double seconds) {
  const LocalFrame site(geo_point_from_degrees(49.0, 8.4, 110.0));
  GpsModel gps(spec, site, seed);
  GpsErrors result;
  for (int k = 1; k <= static_cast<int>(seconds * spec.rate); ++k) {
    const double t = k / spec.rate;
    const Eigen::Vector3d p(0.5 * t, -20.0, 1.0);
    const auto fix = gps.measure(at(t), t, p);
    if (!fix) continue;
    result.errors.push_back(site.to_enu(fix->position) - p);
    result.fixes.push_back(*fix);
  }
  return result;
}

TEST(Gps, DriftHasItsSigmaAndItsCorrelationTime) {
  GpsSpec spec;
  spec.white_sigma = 0.0;
  spec.drift_sigma = 2.0;
  spec.correlation_time = 30.0;
  Eigen::Vector3d square = Eigen::Vector3d::Zero(), later = Eigen::Vector3d::Zero();
  constexpr int kSeeds = 1500;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const GpsErrors run = gps_errors(spec, seed, 31.0);
    square += run.errors[0].cwiseAbs2() / kSeeds;
    later += run.errors[0].cwiseProduct(run.errors[150]) / kSeeds;  // 30 s on
  }
  EXPECT_NEAR(std::sqrt(square.x()), 2.0, 0.12);
  EXPECT_NEAR(std::sqrt(square.y()), 2.0, 0.12);
  EXPECT_NEAR(std::sqrt(square.z()), 4.0, 0.24);
  EXPECT_NEAR(later.x() / square.x(), std::exp(-1.0), 0.08);
  EXPECT_NEAR(later.y() / square.y(), std::exp(-1.0), 0.08);
}

TEST(Gps, ReportedCovarianceIsTheMeanError) {
  GpsSpec spec;
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    square += std::pow(gps_errors(spec, seed, 0.2).errors[0].x(), 2) / 1500;
  }
  EXPECT_NEAR(square / gps_errors(spec, 1, 0.2).fixes[0].covariance(0, 0), 1.0, 0.12);
  spec.covariance_factor = 4.0;
  EXPECT_NEAR(gps_errors(spec, 1, 0.2).fixes[0].covariance(0, 0) / square, 4.0, 0.5);
}

TEST(Gps, OutagesHaveNoFixesAndChangeNoOthers) {
  GpsSpec spec;
  const GpsErrors whole = gps_errors(spec, 3, 60.0);
  spec.outages = {{10.0, 20.0}, {40.0, 41.0}};
  const GpsErrors run = gps_errors(spec, 3, 60.0);
  EXPECT_EQ(whole.fixes.size() - run.fixes.size(), 55u);
  for (const sensor::Fix& fix : run.fixes) {
    const double t = to_seconds(fix.stamp);
    EXPECT_FALSE((t >= 10.0 && t < 20.0) || (t >= 40.0 && t < 41.0)) << t;
  }
  EXPECT_EQ(run.errors.back(), whole.errors.back());
  spec.fitted = false;
  EXPECT_TRUE(gps_errors(spec, 3, 60.0).fixes.empty());
}

TEST(Gps, JumpsComeAtTheirRateLastAndGo) {
  GpsSpec spec;
  spec.white_sigma = spec.drift_sigma = 0.0;
  spec.jumps_per_hour = 60.0;
  spec.jump_size = 8.0;
  spec.jump_duration = 10.0;
  int away = 0, fixes = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    for (const Eigen::Vector3d& error : gps_errors(spec, seed, 600.0).errors) {
      const bool jumped = error.norm() > 1.0;
      EXPECT_NEAR(error.norm(), jumped ? 8.0 : 0.0, 1e-3);
      away += jumped, ++fixes;
    }
  }
  EXPECT_NEAR(static_cast<double>(away) / fixes, 10.0 / 70.0, 0.02);  // 60 s of peace, 10 s of jump
}

TEST(Gps, AltitudeSwingsByItsWaveAndChangesNoOtherError) {
  GpsSpec spec;
  const GpsErrors level = gps_errors(spec, 5, 120.0);
  spec.altitude_wave = 5.0;
  spec.altitude_period = 120.0;
  const GpsErrors run = gps_errors(spec, 5, 120.0);
  double highest = 0.0, lowest = 0.0;
  for (std::size_t k = 0; k < run.errors.size(); ++k) {
    const Eigen::Vector3d wave = run.errors[k] - level.errors[k];
    EXPECT_LT(wave.head<2>().norm(), 1e-3);
    highest = std::max(highest, wave.z());
    lowest = std::min(lowest, wave.z());
  }
  EXPECT_NEAR(highest, 5.0, 0.01);
  EXPECT_NEAR(lowest, -5.0, 0.01);
  EXPECT_EQ(run.fixes.back().covariance, level.fixes.back().covariance);
}

TEST(Wheels, ScaleIsConstantAndSlipGrowsWithTurning) {
  WheelSpec spec;
  spec.slip = 0.01;
  spec.slip_turning = 0.1;
  spec.speed_noise = spec.yaw_rate_noise = 0.0;
  double scales = 0.0, straight = 0.0, turning = 0.0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    WheelSpec plain = spec;
    plain.slip = plain.slip_turning = 0.0;
    WheelModel exact(plain, seed), slipping(spec, seed);
    const double scale = exact.measure(at(0), 1.0, 0.5).forward_speed;
    EXPECT_DOUBLE_EQ(exact.measure(at(0.05), 2.0, 0.0).forward_speed, 2.0 * scale);
    scales += (scale - 1.0) * (scale - 1.0) / 400;
    straight += std::pow(slipping.measure(at(0), 1.0, 0.0).forward_speed / scale - 1.0, 2) / 400;
    turning += std::pow(slipping.measure(at(0.05), 1.0, 1.0).forward_speed / scale - 1.0, 2) / 400;
  }
  EXPECT_NEAR(std::sqrt(scales), spec.scale_sigma, 0.002);
  EXPECT_NEAR(std::sqrt(straight), 0.01, 0.002);
  EXPECT_NEAR(std::sqrt(turning), 0.11, 0.02);
}

TEST(Wheels, YawRateIsOptional) {
  WheelSpec spec;
  EXPECT_TRUE(WheelModel(spec, 1).measure(at(0), 1.0, 0.5).yaw_rate);
  spec.reports_yaw_rate = false;
  EXPECT_FALSE(WheelModel(spec, 1).measure(at(0), 1.0, 0.5).yaw_rate);
}

TEST(SensorSpecs, NameTheFieldThatIsWrong) {
  ImuSpec imu;
  imu.accel_noise = std::nan("");
  EXPECT_THAT(imu.validate().error().message, HasSubstr("accel_noise"));
  GpsSpec gps;
  gps.outages = {{5.0, 5.0}};
  EXPECT_THAT(gps.validate().error().message, HasSubstr("outages"));
  gps.outages.clear();
  gps.correlation_time = 0.0;
  EXPECT_THAT(gps.validate().error().message, HasSubstr("correlation_time"));
  WheelSpec wheels;
  wheels.rate = -1.0;
  EXPECT_THAT(wheels.validate().error().message, HasSubstr("rate"));
}

}  // namespace
}  // namespace fleetmap::sim
