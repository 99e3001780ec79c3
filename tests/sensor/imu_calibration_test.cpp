#include "fleetmap/sensor/imu_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_drive.hpp"
#include "normalised_errors.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::HasSubstr;

double sigma(const ImuCalibration& found, Eigen::Index k) { return std::sqrt(found.covariance(k, k)); }

TEST(ImuCalibration, FindsAnyMountWithinTheSigmasThatItStates) {
  NormalisedErrors errors;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const MadeDrive made = made_drive(seed, {.seconds = 60.0});
    const auto found = calibrate_imu(made.drive, Pose::Identity());
    ASSERT_TRUE(found) << found.error().message;
    const Eigen::Vector3d shift = found->T_base_imu.translation() - made.T_base_imu.translation();
    const Eigen::Vector3d turn = so3_log(found->T_base_imu.linear() * made.T_base_imu.linear().transpose());
    for (Eigen::Index k = 0; k < 3; ++k) {
      errors.add(shift[k], sigma(*found, k));
      errors.add(turn[k], sigma(*found, k + 3));
    }
    errors.add(found->delay.value - made.imu_delay, found->delay.sigma);
    EXPECT_LT(sigma(*found, 0), 0.02);
    EXPECT_LT(sigma(*found, 3), 0.001);
    EXPECT_LT(sigma(*found, 5), 0.01) << "yaw, by the forces";
    EXPECT_LT(found->delay.sigma, 0.002);
  }
  EXPECT_GT(errors.rms(), 0.5);
  EXPECT_LT(errors.rms(), 1.7);
  EXPECT_LT(errors.worst(), 4.5);
}

TEST(ImuCalibration, OnFlatGroundTheHeightOfTheArmIsNotObservable) {
  const MadeDrive made = made_drive(5, {.seconds = 60.0, .sway = 0.0});
  const auto found = calibrate_imu(made.drive, Pose::Identity());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_GT(sigma(*found, 2), kMaxLeverSigma);
  for (Eigen::Index k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(found->T_base_imu.translation()[k] - made.T_base_imu.translation()[k]),
              4.0 * sigma(*found, k));
  }
}

TEST(ImuCalibration, NeedsTurnsAndSamples) {
  MadeDrive straight = made_drive(6, {.seconds = 30.0, .turn_rate = 0.0, .sway = 0.0});
  EXPECT_THAT(calibrate_imu(straight.drive, Pose::Identity()).error().message, HasSubstr("hardly turned"));
  straight.drive.imu.clear();
  EXPECT_THAT(calibrate_imu(straight.drive, Pose::Identity()).error().message, HasSubstr("no IMU"));
}

}  // namespace
}  // namespace fleetmap::sensor
