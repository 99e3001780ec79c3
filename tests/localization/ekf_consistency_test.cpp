#include <gtest/gtest.h>

#include <cmath>

#include "localization/synthetic_drive.hpp"

namespace fleetmap::localization {
namespace {

using namespace testing;

struct Summary {
  double nees = 0.0;  ///< mean over seeds and times; 6 if the covariance is exact, less if it is cautious
  double nees_horizontal = 0.0;
  double horizontal_rms = 0.0;
  double yaw_rms = 0.0;
  double sigma_horizontal_rms = 0.0;
};

/// Runs the filter over `seeds` and compares with the truth each second after `from`.
Summary run(Sensors sensors, const EkfConfig& config, unsigned seeds = 12, double from = 40.0,
            double until = 100.0) {
  const Drive drive(until);
  Summary sum;
  int count = 0;
  for (sensors.seed = 1; sensors.seed <= seeds; ++sensors.seed) {
    Ekf ekf(config);
    double next = from;
    for (const Sample& sample : sensors.measure(drive, until)) {
      add(ekf, sample);
      const double t = to_seconds(stamp_of(sample) - at_time(0));
      if (t < next) continue;
      next += 1.0;
      const auto G = ekf.pose();
      if (!G || !ekf.heading_known()) continue;
      const PoseError error = error_of(*G, drive.at(t));
      sum.nees += error.nees;
      sum.nees_horizontal += error.nees_horizontal;
      sum.horizontal_rms += error.position.head<2>().squaredNorm();
      sum.yaw_rms += error.rotation.z() * error.rotation.z();
      sum.sigma_horizontal_rms += G->covariance(0, 0) + G->covariance(1, 1);
      ++count;
    }
  }
  EXPECT_GE(count, static_cast<int>(seeds) * static_cast<int>(0.9 * (until - from)));
  sum.nees /= count;
  sum.nees_horizontal /= count;
  sum.horizontal_rms = std::sqrt(sum.horizontal_rms / count);
  sum.yaw_rms = std::sqrt(sum.yaw_rms / count);
  sum.sigma_horizontal_rms = std::sqrt(sum.sigma_horizontal_rms / count);
  return sum;
}

EkfConfig white_gps() {
  EkfConfig config;
  config.gps.correlation_time = 0.0;
  return config;
}

/// Sensors whose errors are as the models of the filter say: bounds on the mean NEES are those of a
/// chi-square mean with about one independent error each 20 s: 12 seeds x 3 x 6 degrees of freedom give 6
/// +- 1.2 (two sigma).
TEST(EkfConsistency, CovarianceIsNeitherTooSmallNorUselesslyLargeWithWhiteErrors) {
  EkfConfig config = white_gps();
  config.wheel.correlation_time = 0.0;
  config.wheel.speed_scale = 0.0;
  const Summary sum = run({}, config);
  EXPECT_LT(sum.nees, 7.5);
  EXPECT_GT(sum.nees, 2.0);
  EXPECT_LT(sum.nees_horizontal, 3.0);
  EXPECT_LT(sum.horizontal_rms, 0.6);
  EXPECT_LT(sum.yaw_rms, 0.04);
}

TEST(EkfConsistency, CorrelatedGpsErrorsDoNotMakeTheCovarianceVanish) {
  Sensors sensors;
  sensors.gps_time = 60.0;
  const Summary honest = run(sensors, EkfConfig{}, 30);
  EXPECT_LT(honest.nees_horizontal, 3.2);  // 2 +- 0.5 per 60 independent errors, and some for linearisation
  EXPECT_GT(honest.sigma_horizontal_rms, 0.8);
  const Summary naive = run(sensors, white_gps(), 30);
  EXPECT_GT(naive.nees_horizontal, 10.0) << "the case that the correlation time is there for";
}

TEST(EkfConsistency, WhiteGpsIsNotShutOutByTheModelOfCorrelatedErrors) {
  const Summary sum = run({}, EkfConfig{});
  EXPECT_LT(sum.nees_horizontal, 2.0);
  EXPECT_LT(sum.horizontal_rms, 1.0);
}

TEST(EkfConsistency, ImuAtTenHertz) {
  Sensors sensors;
  sensors.imu_rate = 10.0;
  const Summary sum = run(sensors, white_gps());
  EXPECT_LT(sum.nees, 7.5);
  EXPECT_LT(sum.horizontal_rms, 0.6);
}

TEST(EkfConsistency, ImuAt250HertzMountedAtAnAngleAwayFromBaseLink) {
  Sensors sensors;
  sensors.imu_rate = 250.0;
  sensors.mounting.T_base_imu = make_pose(rotation_from_rpy(0.1, 3.1, 0.5), Eigen::Vector3d(0.3, 0.2, 0.1));
  EkfConfig config = white_gps();
  config.mounting = sensors.mounting;
  const Summary sum = run(sensors, config, 5);
  EXPECT_LT(sum.nees, 7.5);
  EXPECT_LT(sum.horizontal_rms, 0.6);
}

TEST(EkfConsistency, WithoutImu) {
  Sensors sensors;
  sensors.imu = false;
  const Summary sum = run(sensors, white_gps());
  EXPECT_LT(sum.nees, 7.5);
  EXPECT_LT(sum.horizontal_rms, 0.7);
  EXPECT_LT(sum.yaw_rms, 0.1);
}

TEST(EkfConsistency, WithoutWheels) {
  Sensors sensors;
  sensors.wheel = false;
  const Summary sum = run(sensors, white_gps());
  EXPECT_LT(sum.nees, 7.5);
  EXPECT_LT(sum.horizontal_rms, 0.8);
}

TEST(EkfConsistency, GpsOutageOfAMinuteGrowsTheCovarianceAsTheErrorGrows) {
  Sensors sensors;
  sensors.gps_out = [](double t) { return t > 60.0; };
  const Summary before = run(sensors, white_gps(), 12, 40.0, 60.0);
  const Summary during = run(sensors, white_gps(), 12, 100.0, 120.0);
  EXPECT_LT(during.nees, 7.5);
  EXPECT_LT(during.nees_horizontal, 3.0);
  EXPECT_GT(during.sigma_horizontal_rms, 2.0 * before.sigma_horizontal_rms);
  EXPECT_LT(during.horizontal_rms, 4.0);
}

TEST(EkfConsistency, LeverArmOfTheAntennaMatters) {
  Sensors sensors;
  sensors.mounting.p_base_antenna = {-1.0, 0.5, 1.2};
  sensors.gps_sigma = 0.02;
  EkfConfig config = white_gps();
  const Summary ignored = run(sensors, config, 3);
  config.mounting = sensors.mounting;
  const Summary known = run(sensors, config, 3);
  EXPECT_LT(known.horizontal_rms, 0.05);
  EXPECT_LT(known.nees, 8.0);
  EXPECT_GT(ignored.horizontal_rms, 0.8);
}

}  // namespace
}  // namespace fleetmap::localization
