#include "fleetmap/odometry/loam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/field_bounds.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

using fleetmap::testing::kNaN;
using testing::ScanOptions;
using testing::SyntheticDrive;

/// Drives straight on through the yard at 1 m/s, scan by scan.
class LoamInYard : public ::testing::Test {
 protected:
  LoamInYard() : loam_(config(), vlp16()) {}

  static LoamConfig config() {
    LoamConfig config;
    config.T_base_lidar = ScanOptions{}.T_base_lidar;
    return config;
  }
  sensor::Scan scan_at(double seconds) const {
    return make_scan(
        world_, [this](double t) { return motion_.at(t); }, seconds, vlp16());
  }
  Result<OdometryUpdate> add(double seconds) { return loam_.add_scan(scan_at(seconds)); }
  void start() {
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(add(0.1 * k));
  }
  double error_at(double seconds, const OdometryUpdate& update) const {
    return (motion_.at(seconds).translation() - update.T_odom_base.translation()).norm();
  }
  void expect_still_works(double seconds) {
    const auto update = add(seconds);
    ASSERT_TRUE(update) << update.error().message;
    EXPECT_FALSE(update->lost);
    EXPECT_LT(error_at(seconds, *update), 0.05);
  }

  testing::SyntheticWorld world_ = testing::yard_world();
  SyntheticDrive motion_{{{0.3, 0, 0}, {30, 1.0, 0}}, 1.0, 2.0, 0.0};
  Loam loam_;
};

TEST_F(LoamInYard, RefusesScansWithNothingInThem) {
  start();
  sensor::Scan empty;
  empty.stamp = stamp_from_ns(500'000'000);
  EXPECT_FALSE(loam_.add_scan(empty));
  sensor::Scan all_nan = scan_at(0.5), one_place = scan_at(0.5), zeros = scan_at(0.5);
  for (auto& p : all_nan.points) p.position.setConstant(kNaN<float>);
  for (auto& p : one_place.points) p.position = {3.0f, 1.0f, 0.5f};
  for (auto& p : zeros.points) p.position.setZero();
  EXPECT_FALSE(loam_.add_scan(all_nan));
  EXPECT_FALSE(loam_.add_scan(one_place));
  EXPECT_FALSE(loam_.add_scan(zeros));
  EXPECT_EQ(loam_.counters().refused_points, 4u);
  EXPECT_EQ(loam_.counters().points_non_finite, all_nan.points.size());
  expect_still_works(0.6);
}

TEST_F(LoamInYard, CountsSomeBadPointsAndGoesOn) {
  start();
  sensor::Scan scan = scan_at(0.5);
  for (std::size_t i = 0; i < scan.points.size(); i += 10) scan.points[i].position.x() = kNaN<float>;
  for (std::size_t i = 1; i < scan.points.size(); i += 50) scan.points[i].time = 1e9f;
  for (std::size_t i = 2; i < scan.points.size(); i += 50) scan.points[i].position *= 1e30f;
  for (std::size_t i = 3; i < scan.points.size(); i += 50) scan.points[i].ring = 60000;
  const auto update = loam_.add_scan(scan);
  ASSERT_TRUE(update) << update.error().message;
  EXPECT_LT(error_at(0.5, *update), 0.05);
  EXPECT_GT(loam_.counters().points_non_finite, 1000u);
  EXPECT_GT(loam_.counters().points_bad_time, 100u);
  for (const auto& p : update->points.points) EXPECT_TRUE(p.allFinite());
}

TEST_F(LoamInYard, IgnoresFieldsThatContradictThePoints) {
  start();
  sensor::Scan scan = scan_at(0.5);
  std::mt19937 random(3);
  for (auto& p : scan.points) {
    p.ring = static_cast<std::uint16_t>(random() % 16);
    p.time *= 1e9f;  // nanoseconds taken for seconds
  }
  const auto update = loam_.add_scan(scan);
  ASSERT_TRUE(update) << update.error().message;
  EXPECT_EQ(loam_.counters().rings_ignored, 1u);
  EXPECT_EQ(loam_.counters().times_ignored, 1u);
  EXPECT_LT(error_at(0.5, *update), 0.05);
}

TEST_F(LoamInYard, RefusesTimeGoingBack) {
  start();
  EXPECT_FALSE(add(0.2));
  EXPECT_FALSE(add(0.4));
  EXPECT_EQ(loam_.counters().refused_time, 2u);
  expect_still_works(0.5);
}

TEST_F(LoamInYard, FollowsAClockThatWasSetBack) {
  for (int k = 0; k < 5; ++k) {
    sensor::Scan scan = scan_at(0.1 * k);
    scan.stamp += std::chrono::hours(1);
    ASSERT_TRUE(loam_.add_scan(scan));
  }
  EXPECT_FALSE(add(0.5));
  EXPECT_FALSE(add(0.6));
  ASSERT_TRUE(add(0.7));
  EXPECT_EQ(loam_.counters().clock_resets, 1u);
  expect_still_works(0.8);
}

/// A driver that hangs: the points of one scan again and again, under new stamps.
TEST_F(LoamInYard, RefusesRepeatedPointsOfARobotThatMovesAndBeginsAnewAfterSeconds) {
  start();
  sensor::Scan frozen = scan_at(0.5);
  ASSERT_TRUE(loam_.add_scan(frozen));
  for (int k = 6; k < 60; ++k) {
    frozen.stamp = stamp_from_ns(k * 100'000'000LL);
    const auto update = loam_.add_scan(frozen);
    ASSERT_FALSE(update) << k;
    EXPECT_NE(update.error().message.find("the very points of the scan before"), std::string::npos);
  }
  EXPECT_EQ(loam_.counters().refused_repeated, 54u);
  const auto update = add(6.0);
  ASSERT_TRUE(update) << update.error().message;
  EXPECT_TRUE(update->lost);
  EXPECT_EQ(loam_.counters().map_restarts, 1u);
  EXPECT_GT(std::sqrt(update->covariance(0, 0)), 1.0);
}

/// The robot stood when its driver began to hang: where it went since nobody knows.
TEST_F(LoamInYard, APlaceThatIsNotThatOfTheRepeatedPointsBeginsAnew) {
  sensor::Scan scan = scan_at(0.0);
  for (int k = 0; k < 30; ++k) {
    scan.stamp = stamp_from_ns(k * 100'000'000LL);
    ASSERT_TRUE(loam_.add_scan(scan));
  }
  sensor::Scan elsewhere = scan_at(20.0);
  elsewhere.stamp = stamp_from_ns(3'000'000'000LL);
  const auto update = loam_.add_scan(elsewhere);
  ASSERT_TRUE(update) << update.error().message;
  EXPECT_TRUE(update->lost);
  EXPECT_EQ(loam_.counters().map_restarts, 1u);
}

/// A simulated LiDAR without noise repeats itself while the robot stands.
TEST_F(LoamInYard, RepeatedPointsOfARobotThatStandsAreTaken) {
  sensor::Scan scan = scan_at(0.0);
  for (int k = 0; k < 30; ++k) {
    scan.stamp = stamp_from_ns(k * 100'000'000LL);
    const auto update = loam_.add_scan(scan);
    ASSERT_TRUE(update) << update.error().message;
    EXPECT_FALSE(update->lost);
    EXPECT_LT(update->T_odom_base.translation().norm(), 0.01);
  }
  EXPECT_EQ(loam_.counters().refused_repeated, 0u);
}

TEST_F(LoamInYard, RecoversAfterAGap) {
  start();
  for (int k = 5; k < 30; ++k) ASSERT_TRUE(add(0.1 * k));
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(add(4.5 + 0.1 * k));  // 1.6 s, 1.6 m later
  expect_still_works(5.0);
  EXPECT_EQ(loam_.counters().map_restarts, 0u);
}

TEST_F(LoamInYard, AfterALongGapItBeginsAnewAndSaysSo) {
  start();
  for (int k = 5; k < 30; ++k) ASSERT_TRUE(add(0.1 * k));
  const auto first = add(9.0);  // 6 m later, and nothing told of the way
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->lost);
  EXPECT_EQ(loam_.counters().map_restarts, 1u);
  EXPECT_GT(first->covariance(0, 0), 1.0);
  ASSERT_TRUE(add(9.1));
  const auto from = add(9.2), to = add(10.0);
  ASSERT_TRUE(from && to);
  EXPECT_FALSE(to->lost);
  const double way = (to->T_odom_base.translation() - from->T_odom_base.translation()).norm();
  EXPECT_NEAR(way, (motion_.at(10.0).translation() - motion_.at(9.2).translation()).norm(), 0.05);
}

TEST_F(LoamInYard, AClockThatIsSetFarAheadMovesNothing) {
  start();
  for (int k = 5; k < 30; ++k) ASSERT_TRUE(add(0.1 * k));
  sensor::Scan scan = scan_at(3.0);
  scan.stamp += std::chrono::hours(24 * 365 * 50);
  const auto update = loam_.add_scan(scan);
  ASSERT_TRUE(update);
  EXPECT_TRUE(update->lost);
  EXPECT_LT(error_at(3.0, *update), 0.5);
  EXPECT_TRUE(update->covariance.allFinite());
}

TEST_F(LoamInYard, WheelsAndGyroTellTheWayOfALongGap) {
  start();
  for (int k = 5; k < 30; ++k) ASSERT_TRUE(add(0.1 * k));
  for (int k = 0; k < 1000; ++k) {
    const double t = 2.5 + 0.01 * k;
    const Pose T = motion_.at(t).inverse() * motion_.at(t + 0.01);
    sensor::Imu imu;
    imu.stamp = stamp_from_ns(static_cast<std::int64_t>(t * 1e9));
    imu.angular_velocity = so3_log(T.linear()) / 0.01;
    loam_.add_imu(imu);
    loam_.add_wheel({imu.stamp, 1.02 * T.translation().norm() / 0.01, std::nullopt});
  }
  expect_still_works(9.0);
  EXPECT_EQ(loam_.counters().map_restarts, 0u);
}

TEST_F(LoamInYard, RandomPointsNeverCrashIt) {
  std::mt19937_64 random(11);
  std::normal_distribution<float> normal(0.0f, 20.0f);
  const float odd[] = {0.0f, kNaN<float>, std::numeric_limits<float>::infinity(), -1e38f, 1e-38f};
  for (int k = 0; k < 60; ++k) {
    sensor::Scan scan;
    scan.stamp = stamp_from_ns(static_cast<std::int64_t>(random() % 20'000'000'000ull));
    scan.has_time = random() % 2 == 0;
    scan.has_ring = random() % 2 == 0;
    scan.points.resize(random() % 3000);
    for (auto& p : scan.points) {
      p.position = {normal(random), normal(random), 0.2f * normal(random)};
      if (random() % 20 == 0) p.position[static_cast<int>(random() % 3)] = odd[random() % 5];
      p.time = random() % 20 == 0 ? odd[random() % 5] : 0.05f * normal(random) / 20.0f;
      p.ring = static_cast<std::uint16_t>(random() % (random() % 2 == 0 ? 16 : 65536));
    }
    const auto update = loam_.add_scan(scan);
    if (!update) {
      EXPECT_FALSE(update.error().message.empty());
      continue;
    }
    EXPECT_TRUE(all_finite(update->T_odom_base));
    EXPECT_TRUE(update->covariance.allFinite());
  }
  const LoamCounters& c = loam_.counters();
  EXPECT_EQ(c.scans, c.updates + c.refused_points + c.refused_time);
}

TEST_F(LoamInYard, BadInertialAndWheelSamplesAreDropped) {
  sensor::Imu imu;
  imu.angular_velocity.x() = std::nan("");
  loam_.add_imu(imu);
  sensor::Wheel wheel;
  wheel.forward_speed = std::numeric_limits<double>::infinity();
  loam_.add_wheel(wheel);
  EXPECT_EQ(loam_.counters().imu_dropped, 1u);
  EXPECT_EQ(loam_.counters().wheel_dropped, 1u);
  start();
  expect_still_works(0.5);
}

TEST(LoamConfig, NamesTheFieldThatBreaksARule) {
  EXPECT_TRUE(LoamConfig{}.validate());
  LoamConfig config;
  config.max_range = std::nan("");
  const Status status = config.validate();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("max_range"), std::string::npos);
  EXPECT_FALSE(Loam(config, vlp16()).add_scan({}));
}

}  // namespace
}  // namespace fleetmap::odometry
