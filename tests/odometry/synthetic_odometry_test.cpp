#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/odometry/motion_covariance.hpp"
#include "odometry/stated_drive.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/measured.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

using testing::DriveLeg;
using testing::ScanOptions;
using testing::SyntheticDrive;

const std::vector<DriveLeg> kErrands = testing::errands();

struct DriveResult {
  std::vector<Pose> estimate, truth;
  LoamCounters counters;
};

DriveResult drive(const testing::SyntheticWorld& world, const SyntheticDrive& motion,
                  const LidarModel& scanner, const LidarModel& assumed, const ScanOptions& options) {
  LoamConfig config;
  config.T_base_lidar = options.T_base_lidar;
  Loam loam(config, assumed);
  DriveResult run;
  for (int k = 0; 0.1 * (k + 1) < motion.duration(); ++k) {
    const auto pose_at = [&](double t) { return motion.at(t); };
    const auto update = loam.add_scan(make_scan(world, pose_at, 0.1 * k, scanner, options));
    if (!update) {
      ADD_FAILURE() << update.error().message;
      break;
    }
    run.estimate.push_back(update->T_odom_base);
    run.truth.push_back(motion.at(0.1 * k));
  }
  run.counters = loam.counters();
  return run;
}

/// Bounds (one drive each, a third more than measured): docs/reference/test_bounds.md.
void expect_drift(const std::vector<Pose>& estimate, const std::vector<Pose>& truth, double max_per_cent,
                  const std::string& what) {
  fleetmap::testing::expect_at_most(100.0 * testing::relative_drift(estimate, truth, 20.0), max_per_cent,
                                    "drift over 20 m, %, " + what, 1);
}

TEST(SyntheticOdometry, Vlp16DriftsLittleOverErrands) {
  const DriveResult run = drive(testing::yard_world(), SyntheticDrive(kErrands), vlp16(), vlp16(), {});
  expect_drift(run.estimate, run.truth, 0.058, "VLP-16");
  EXPECT_EQ(run.counters.lost, 0u);
}

TEST(SyntheticOdometry, Vlp16WithoutRingsOrTimes) {
  ScanOptions options;
  options.has_ring = options.has_time = false;
  const DriveResult run = drive(testing::yard_world(), SyntheticDrive(kErrands), vlp16(), vlp16(), options);
  expect_drift(run.estimate, run.truth, 0.058, "VLP-16 without rings or times");
}

TEST(SyntheticOdometry, HalfOfTheRaysMissing) {
  ScanOptions options;
  options.keep = 0.5;
  const DriveResult run = drive(testing::yard_world(), SyntheticDrive(kErrands), vlp16(), vlp16(), options);
  expect_drift(run.estimate, run.truth, 0.032, "half of the rays");
  EXPECT_EQ(run.counters.lost, 0u);
}

TEST(SyntheticOdometry, NonRepeatingPatternWithoutRings) {
  const DriveResult run =
      drive(testing::yard_world(), SyntheticDrive(kErrands), generic_lidar(), generic_lidar(), {});
  expect_drift(run.estimate, run.truth, 0.01, "non-repeating");
}

TEST(SyntheticOdometry, NeverLostBetweenRowsOfPanels) {
  const SyntheticDrive motion({{1, 0, 0}, {12, 1.5, 0}, {1, 0, 0}, {4, 0, 0.8}, {1, 0, 0}, {8, 1.5, 0}});
  for (const LidarModel& model : {vlp16(), generic_lidar()}) {
    const DriveResult run = drive(testing::panel_world(), motion, model, model, {});
    expect_drift(run.estimate, run.truth, model.has_rings() ? 0.037 : 0.108, "between panels, " + model.name);
    EXPECT_EQ(run.counters.lost, 0u) << model.name;
  }
}

/// Between two smooth walls the scene slides along itself: that direction, and no other, is reported, its
/// variance is large, and wheel speed settles it.
TEST(SyntheticOdometry, CorridorIsDegenerateAlongItself) {
  const SyntheticDrive motion({{0.5, 0, 0}, {5, 1.5, 0}}, 1.0, 2.0, 0.0);
  const testing::SyntheticWorld world = testing::corridor_world();
  LoamConfig config;
  config.T_base_lidar = ScanOptions{}.T_base_lidar;
  Loam loam(config, vlp16());
  double fed = 0.0, travelled = 0.0;
  int degenerate = 0, scans = 0;
  for (double t = 0.0; t + 0.1 < motion.duration(); t += 0.1) {
    for (; fed < t + 0.12; fed += 0.02) loam.add_wheel(motion.wheel(fed));
    const auto update = loam.add_scan(make_scan(
        world, [&](double s) { return motion.at(s); }, t, vlp16()));
    ASSERT_TRUE(update) << update.error().message;
    travelled = update->T_odom_base.translation().x();
    if (t < 0.15) continue;
    ++scans;
    if (update->degenerate_count == 0) continue;
    ++degenerate;
    EXPECT_EQ(update->degenerate_count, 1);
    EXPECT_GT(std::abs(update->degenerate_directions(0, 0)), 0.99);
    EXPECT_GT(update->pose_noise(0, 0), update->pose_noise(1, 1));
    EXPECT_NEAR(update->T_odom_base.translation().y(), 0.0, 0.03);
  }
  EXPECT_GT(degenerate, scans * 3 / 4);
  EXPECT_NEAR(travelled, motion.at(motion.duration() - 0.1).translation().x(), 0.02 * travelled + 0.15);
}

/// A turned IMU with an unknown bias of 1.5 deg/s. While it is being learned it tilts the first scans by some
/// tenths of a degree, which nothing states; from then on the summed covariances cover the error of the
/// drive.
TEST(SyntheticOdometry, GyroPriorWithBiasDoesNoHarm) {
  const SyntheticDrive motion(kErrands);
  const testing::SyntheticWorld world = testing::yard_world();
  LoamConfig config;
  config.T_base_lidar = ScanOptions{}.T_base_lidar;
  config.q_base_imu = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  Loam loam(config, vlp16());
  std::vector<Pose> estimate, truth;
  double fed = 0.0;
  MotionCovariance uncertainty;
  constexpr int kLearned = 50;  // scans
  for (int k = 0; 0.1 * (k + 1) < motion.duration(); ++k) {
    const double t = 0.1 * k;
    for (; fed < t + 0.12; fed += 0.01) {
      sensor::Imu imu = motion.imu(fed);
      imu.angular_velocity =
          config.q_base_imu.conjugate() * imu.angular_velocity + Eigen::Vector3d(0.01, -0.02, 0.015);
      loam.add_imu(imu);
    }
    const auto update = loam.add_scan(make_scan(
        world, [&](double s) { return motion.at(s); }, t, vlp16()));
    ASSERT_TRUE(update) << update.error().message;
    estimate.push_back(update->T_odom_base);
    truth.push_back(motion.at(t));
    if (k >= kLearned) uncertainty.add(*update);
  }
  expect_drift(estimate, truth, 0.058, "gyro with a bias");
  const auto error_between = [&](std::size_t from, std::size_t to) {
    return Vector6d(
        se3_log((truth[from].inverse() * truth[to]).inverse() * (estimate[from].inverse() * estimate[to])));
  };
  EXPECT_LT(error_between(0, kLearned).tail<3>().norm(), 0.01);
  const Vector6d error = error_between(kLearned, truth.size() - 1);
  const Matrix6d covariance = uncertainty.since_reference();
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(error[i]), 3.3 * std::sqrt(covariance(i, i))) << i;
  EXPECT_LT(std::sqrt(covariance.topLeftCorner<3, 3>().trace()), 0.5);
}

struct Swaying {
  double tilt_error = 0.0;   ///< rad, RMS of roll and pitch since the first scan
  double tilt_stated = 0.0;  ///< rad, RMS of what is stated for them
};

/// Straight on for some seconds while the body pitches by 0.02 rad at `rate` Hz and rolls by half of it.
Swaying drive_swaying(double rate, bool with_gyro) {
  const SyntheticDrive motion({{1, 0, 0}, {5, 1.5, 0}});
  const auto pose_at = [&](double t) {
    const double phase = 2.0 * std::numbers::pi * rate * t;
    return Pose(motion.at(t) *
                make_pose(rotation_from_rpy(0.01 * std::cos(phase), 0.02 * std::sin(phase), 0.0),
                          Eigen::Vector3d::Zero()));
  };
  const testing::SyntheticWorld world = testing::yard_world();
  LoamConfig config;
  config.T_base_lidar = ScanOptions{}.T_base_lidar;
  Loam loam(config, vlp16());
  Swaying result;
  std::vector<Pose> offsets;
  double fed = 0.0;
  for (int k = 0; k < 58; ++k) {
    const double t = 0.1 * k;
    for (; with_gyro && fed < t + 0.12; fed += 0.01) {
      sensor::Imu imu = motion.imu(fed);
      imu.angular_velocity =
          so3_log(pose_at(fed - 0.005).linear().transpose() * pose_at(fed + 0.005).linear()) / 0.01;
      loam.add_imu(imu);
    }
    const auto update = loam.add_scan(make_scan(world, pose_at, t, vlp16()));
    if (!update || k < 20) continue;
    offsets.push_back(pose_at(t) * update->T_odom_base.inverse());
    const Vector6d error = se3_log(update->T_odom_base.inverse() * offsets.front().inverse() * pose_at(t));
    result.tilt_error += error.segment<2>(3).squaredNorm();
    result.tilt_stated += update->pose_noise(3, 3) + update->pose_noise(4, 4);
  }
  const auto count = 2.0 * static_cast<double>(offsets.size());
  result.tilt_error = std::sqrt(result.tilt_error / count);
  result.tilt_stated = std::sqrt(result.tilt_stated / count);
  return result;
}

/// RMS in m of what is stated for x, straight on while the body is shoved to and fro by `shove` m at 2.3 Hz.
double stated_along(double shove) {
  const SyntheticDrive motion({{1, 0, 0}, {5, 1.5, 0}});
  const auto pose_at = [&](double t) {
    const double phase = 2.0 * std::numbers::pi * 2.3 * t;
    return Pose(motion.at(t) * Eigen::Translation3d(shove * std::sin(phase), 0.0, 0.0));
  };
  const testing::SyntheticWorld world = testing::yard_world();
  LoamConfig config;
  config.T_base_lidar = ScanOptions{}.T_base_lidar;
  Loam loam(config, vlp16());
  double stated = 0.0;
  for (int k = 0; k < 40; ++k) {
    const auto update = loam.add_scan(make_scan(world, pose_at, 0.1 * k, vlp16()));
    if (update && k >= 20) stated += update->pose_noise(0, 0) / 20.0;
  }
  return std::sqrt(stated);
}

/// A smooth drive determines the motion better than a shaken one, though both have the same prior.
TEST(SyntheticOdometry, NoiseIsStatedByHowTheMotionKeepsToItsPrior) {
  EXPECT_GT(stated_along(0.03), 1.3 * stated_along(0.0));
}

/// A body on rough ground does not turn evenly during a scan. A gyro tells how; without one the scan tells
/// less, and so it is stated. A velocity that follows the bend of the map errs here by 3.3 mrad and states
/// 0.7.
TEST(SyntheticOdometry, SwayDuringAScanIsFollowedOrStated) {
  const Swaying estimated = drive_swaying(1.2, true), guessed = drive_swaying(1.2, false);
  EXPECT_LT(estimated.tilt_error, 0.7 * guessed.tilt_error);
  EXPECT_LT(estimated.tilt_stated, 0.9 * guessed.tilt_stated);
  EXPECT_LT(guessed.tilt_error, 0.001);
  EXPECT_LT(guessed.tilt_error, guessed.tilt_stated);
  EXPECT_LT(estimated.tilt_error, estimated.tilt_stated);
}

}  // namespace
}  // namespace fleetmap::odometry
