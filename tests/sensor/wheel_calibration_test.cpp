#include "fleetmap/sensor/wheel_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "made_drive.hpp"
#include "normalised_errors.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::HasSubstr;

TEST(WheelCalibration, FindsTheLidarsMountWithinTheSigmasThatItStates) {
  NormalisedErrors errors;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const MadeDrive made = made_drive(seed, {.seconds = 60.0});
    const auto found = calibrate_wheels(made.drive);
    ASSERT_TRUE(found) << found.error().message;
    const Eigen::Vector3d shift = found->T_wheels_base.translation() - made.T_wheels_base.translation();
    const Eigen::Vector3d turn =
        so3_log(found->T_wheels_base.linear() * made.T_wheels_base.linear().transpose());
    for (const Eigen::Index k : {0, 1}) errors.add(shift[k], std::sqrt(found->covariance(k, k)));
    for (const Eigen::Index k : {1, 2}) errors.add(turn[k], std::sqrt(found->covariance(k + 3, k + 3)));
    errors.add(found->speed_scale.value - made.speed_scale, found->speed_scale.sigma);
    EXPECT_LT(shift.head<2>().norm(), 0.03);
    EXPECT_LT(turn.norm(), 0.005);
    EXPECT_LT(std::sqrt(found->covariance(5, 5)), 0.003) << "yaw";
  }
  EXPECT_GT(errors.rms(), 0.5);
  EXPECT_LT(errors.rms(), 1.7);
  EXPECT_LT(errors.worst(), 4.5);
}

TEST(WheelCalibration, AStraightDriveShowsYawAndNoLeverArm) {
  const MadeDrive made = made_drive(3, {.seconds = 60.0, .turn_rate = 0.0});
  const auto found = calibrate_wheels(made.drive);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(std::sqrt(found->covariance(5, 5)), kMaxRotationSigma);
  EXPECT_GT(std::sqrt(found->covariance(0, 0)), kMaxLeverSigma);
  EXPECT_GT(std::sqrt(found->covariance(1, 1)), kMaxLeverSigma);
}

TEST(WheelCalibration, NeedsWheelsThatDrive) {
  MadeDrive made = made_drive(1, {.seconds = 20.0});
  for (Wheel& wheel : made.drive.wheels) wheel.forward_speed = 0.0;
  EXPECT_THAT(calibrate_wheels(made.drive).error().message, HasSubstr("less than 5 m"));
  made.drive.wheels.clear();
  EXPECT_THAT(calibrate_wheels(made.drive).error().message, HasSubstr("no wheel odometry"));
}

}  // namespace
}  // namespace fleetmap::sensor
