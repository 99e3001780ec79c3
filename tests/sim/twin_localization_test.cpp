// The EKF on what the twin's IMU, wheels and GPS measure. Bounds: docs/test_sensitivity.md.
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
  double nees = 0.0;
  const unsigned seeds = seeds_to_run(6);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const testing::EkfErrors run = testing::run(drive, seed);
    EXPECT_EQ(run.poses, 701);
    EXPECT_LT(run.worst_force, 4.0);
    EXPECT_LT(run.worst_turn, 1.0);
    expect_at_most(run.horizontal / run.fixes_horizontal, 1.3, "EKF, error over that of the fixes", seed);
    expect_at_most(run.heading, 0.1, "EKF, heading in rad", seed);
    nees += run.nees_horizontal / seeds;
  }
  expect_at_most(nees, 2.0, "EKF, mean NEES", seeds);
  expect_at_least(nees, 0.3, "EKF, mean NEES", seeds);
}

/// With fixes true to centimetres, what is wrong with mounts, lever arms and wheels shows.
TEST(TwinLocalization, WithFixesTrueToCentimetresItIsTrueToCentimetres) {
  testing::EkfDrive drive;
  drive.robot.gps.white_sigma = 0.02;
  drive.robot.gps.drift_sigma = 0.01;
  for (unsigned seed = 1; seed <= seeds_to_run(4); ++seed) {
    const testing::EkfErrors run = testing::run(drive, seed);
    expect_at_most(run.horizontal, 0.1, "EKF with exact fixes, horizontal in m", seed);
    expect_at_most(run.height, 0.1, "EKF with exact fixes, height in m", seed);
    expect_at_most(run.heading, 0.1, "EKF with exact fixes, heading in rad", seed);
    expect_at_most(run.nees_horizontal, 4.0, "EKF with exact fixes, NEES", seed);
  }
}

}  // namespace
}  // namespace fleetmap::sim
