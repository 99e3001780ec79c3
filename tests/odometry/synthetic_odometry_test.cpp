#include <gtest/gtest.h>

#include "fleetmap/odometry/loam.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

using testing::DriveLeg;
using testing::ScanOptions;
using testing::SyntheticDrive;

/// Straight on, a bend, a stop, turns on the spot both ways, a long bend back.
const std::vector<DriveLeg> kErrands{{1, 0, 0}, {10, 1.5, 0}, {4, 1.2, 0.4},  {3, 0, 0},      {4, 0, 1.0},
                                     {1, 0, 0}, {2, 0, -1.0}, {8, 1.5, -0.1}, {4, 1.0, -0.5}, {3, 1.5, 0}};

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

constexpr double kMaxDrift = 0.005;  // of 20 m

TEST(SyntheticOdometry, Vlp16DriftsLittleOverErrands) {
  const DriveResult run = drive(testing::yard_world(), SyntheticDrive(kErrands), vlp16(), vlp16(), {});
  EXPECT_LT(testing::relative_drift(run.estimate, run.truth, 20.0), kMaxDrift);
  EXPECT_EQ(run.counters.lost, 0u);
}

TEST(SyntheticOdometry, Vlp16WithoutRingsOrTimes) {
  ScanOptions options;
  options.has_ring = options.has_time = false;
  const DriveResult run = drive(testing::yard_world(), SyntheticDrive(kErrands), vlp16(), vlp16(), options);
  EXPECT_LT(testing::relative_drift(run.estimate, run.truth, 20.0), kMaxDrift);
}

TEST(SyntheticOdometry, HalfOfTheRaysMissing) {
  ScanOptions options;
  options.keep = 0.5;
  const DriveResult run = drive(testing::yard_world(), SyntheticDrive(kErrands), vlp16(), vlp16(), options);
  EXPECT_LT(testing::relative_drift(run.estimate, run.truth, 20.0), kMaxDrift);
}

TEST(SyntheticOdometry, NonRepeatingPatternWithoutRings) {
  const DriveResult run =
      drive(testing::yard_world(), SyntheticDrive(kErrands), generic_lidar(), generic_lidar(), {});
  EXPECT_LT(testing::relative_drift(run.estimate, run.truth, 20.0), kMaxDrift);
}

}  // namespace
}  // namespace fleetmap::odometry
