// The EKF on what the twin's IMU, wheels and GPS measure. Bounds: docs/reference/test_bounds.md.
#include <gtest/gtest.h>

#include "sim/ekf_drive.hpp"
#include "support/measured.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_at_least;
using fleetmap::testing::expect_at_most;
using fleetmap::testing::seeds_to_run;

TEST(TwinLocalization, ErrsNoMoreThanItsFixesAndStatesHowMuch) {
  const testing::EkfDrive drive;
  double nees = 0.0, ratio = 0.0;
  const unsigned seeds = seeds_to_run(20);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const testing::EkfErrors run = testing::run(drive, seed);
    EXPECT_EQ(run.poses, 701);
    EXPECT_LT(run.worst_force, 4.0);
    EXPECT_LT(run.worst_turn, 1.0);
    expect_at_most(run.horizontal / run.fixes_horizontal, 1.48, "EKF, error over that of the fixes", seed);
    expect_at_most(run.heading, 0.104, "EKF, heading in rad", seed);
    nees += run.nees_horizontal / seeds;
    ratio += run.horizontal / run.fixes_horizontal / seeds;
  }
  expect_at_most(ratio, 0.9, "EKF, mean error over that of the fixes", seeds);  // who echoes the fixes has 1
  expect_at_most(nees, 1.32, "EKF, mean NEES", seeds);
  expect_at_least(nees, 0.66, "EKF, mean NEES", seeds);
}

/// With fixes true to centimetres, what is wrong with mounts, lever arms and wheels shows.
testing::EkfDrive with_exact_fixes() {
  testing::EkfDrive drive;
  drive.robot.gps.white_sigma = 0.02;
  drive.robot.gps.drift_sigma = 0.01;
  return drive;
}
constexpr double kHorizontal = 0.073, kHeight = 0.075;  // m

TEST(TwinLocalization, WithFixesTrueToCentimetresItIsTrueToCentimetres) {
  const testing::EkfDrive drive = with_exact_fixes();
  for (unsigned seed = 1; seed <= seeds_to_run(20); ++seed) {
    const testing::EkfErrors run = testing::run(drive, seed);
    expect_at_most(run.horizontal, kHorizontal, "EKF with exact fixes, horizontal in m", seed);
    expect_at_most(run.height, kHeight, "EKF with exact fixes, height in m", seed);
    expect_at_most(run.heading, 0.071, "EKF with exact fixes, heading in rad", seed);
    expect_at_most(run.nees_horizontal, 1.26, "EKF with exact fixes, NEES", seed);
  }
}

TEST(TwinLocalization, ALeverArmOrAMountThatIsIgnoredBreaksTheBounds) {
  testing::EkfDrive arm = with_exact_fixes(), mount = with_exact_fixes();
  arm.knows_antenna = false;
  mount.knows_imu_mount = false;
  for (unsigned seed = 1; seed <= seeds_to_run(4); ++seed) {
    const testing::EkfErrors without_arm = testing::run(arm, seed), without_mount = testing::run(mount, seed);
    expect_at_least(without_arm.horizontal, kHorizontal, "EKF without lever arm, horizontal in m", seed);
    expect_at_least(without_arm.height, kHeight, "EKF without lever arm, height in m", seed);
    expect_at_least(without_mount.horizontal, kHorizontal, "EKF without IMU mount, horizontal in m", seed);
  }
}

}  // namespace
}  // namespace fleetmap::sim
