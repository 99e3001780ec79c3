#include "fleetmap/sensor/antenna_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_drive.hpp"
#include "normalised_errors.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::HasSubstr;

NormalisedErrors errors_with(const MadeDriveOptions& options, double max_sigma) {
  NormalisedErrors errors;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const MadeDrive made = made_drive(seed, options);
    const auto found = calibrate_antenna(made.drive, Eigen::Vector3d::Zero());
    EXPECT_TRUE(found) << found.error().message;
    if (!found) continue;
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double sigma = std::sqrt(found->covariance(k, k));
      EXPECT_LT(sigma, max_sigma);
      errors.add(found->p_base_antenna[k] - made.p_base_antenna[k], sigma);
    }
    EXPECT_GT(std::sqrt(found->covariance(2, 2)), 5.0 * std::sqrt(found->covariance(0, 0))) << "the height";
  }
  return errors;
}

TEST(AntennaCalibration, FindsTheArmOfAReceiverThatErrsByMetres) {
  const NormalisedErrors errors = errors_with({.seconds = 120.0}, 0.3);
  EXPECT_GT(errors.rms(), 0.5);
  EXPECT_LT(errors.rms(), 1.7);
}

TEST(AntennaCalibration, FindsTheArmOfAnRtkReceiverWithinCentimetres) {
  const NormalisedErrors errors = errors_with({.seconds = 120.0, .gps_white = 0.02, .gps_slow = 0.01}, 0.03);
  EXPECT_GT(errors.rms(), 0.5);
  EXPECT_LT(errors.rms(), 1.7);
}

TEST(AntennaCalibration, NeedsTurnsAndFixes) {
  MadeDrive straight = made_drive(1, {.seconds = 30.0, .turn_rate = 0.0});
  EXPECT_THAT(calibrate_antenna(straight.drive, Eigen::Vector3d::Zero()).error().message,
              HasSubstr("hardly turned"));
  straight.drive.fixes.clear();
  EXPECT_THAT(calibrate_antenna(straight.drive, Eigen::Vector3d::Zero()).error().message,
              HasSubstr("no fixes"));
}

}  // namespace
}  // namespace fleetmap::sensor
