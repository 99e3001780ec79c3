#include "oxts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "recording/timed_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using testing::kBegin;

/// Place k holds 100 + k, except for those whose ranges are smaller: number k is told by its value.
std::string oxts_record(const std::string& latitude = "49", const std::string& yaw = "1.5") {
  std::string text = latitude + " 8.4 110 0 0 " + yaw;
  for (int k = 6; k < 30; ++k) text += " " + std::to_string(100 + k);
  return text + "\n";
}

std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto frame = read_oxts_file(folder.write("0.txt", text), kBegin);
  return frame ? "no error" : frame.error().message;
}

TEST(Oxts, EachNumberGoesToItsPlace) {
  const TemporaryFolder folder;
  const auto frame = read_oxts_file(folder.write("0.txt", oxts_record()), kBegin);
  ASSERT_TRUE(frame) << frame.error().message;
  for (const Stamp stamp : {frame->imu.stamp, frame->fix.stamp, frame->wheel.stamp}) EXPECT_EQ(stamp, kBegin);
  EXPECT_EQ(frame->fix.position, geo_point_from_degrees(49, 8.4, 110));
  EXPECT_TRUE(frame->fix.valid);
  EXPECT_EQ(frame->wheel.forward_speed, 108.0);
  EXPECT_EQ(frame->imu.specific_force, Eigen::Vector3d(111, 112, 113));
  EXPECT_EQ(frame->imu.angular_velocity, Eigen::Vector3d(117, 118, 119));
  EXPECT_EQ(frame->wheel.yaw_rate, 119.0);
  EXPECT_EQ(frame->fix.covariance, 123.0 * 123.0 * Eigen::Matrix3d::Identity());
}

TEST(Oxts, YawCountsFromEastCounterClockwise) {
  const TemporaryFolder folder;
  const auto frame = read_oxts_file(folder.write("0.txt", oxts_record("49", "1.5707963267948966")), kBegin);
  ASSERT_TRUE(frame && frame->imu.q_enu_imu);
  EXPECT_TRUE((*frame->imu.q_enu_imu * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12))
      << "forward is north";
  EXPECT_LT(frame->imu.orientation_variance.x(), frame->imu.orientation_variance.z())
      << "tilt is known better";
}

TEST(Oxts, MissingAndInvalidNumbersAreNamedByPosition) {
  EXPECT_THAT(error_of("49 8.4 110"), ::testing::HasSubstr("0.txt: number 4 of 30 is missing or not finite"));
  EXPECT_THAT(error_of(""), ::testing::HasSubstr("number 1 of 30"));
  EXPECT_THAT(error_of(oxts_record("nan")), ::testing::HasSubstr("number 1 of 30"));
  EXPECT_THAT(error_of(oxts_record("49", "1.5m")), ::testing::HasSubstr("number 6 of 30"));
  EXPECT_THAT(error_of(oxts_record("49", "1e999")), ::testing::HasSubstr("number 6 of 30"));
  EXPECT_EQ(error_of(oxts_record() + "31 32"), "no error");
  const auto none = read_oxts_file("/none/0.txt", kBegin);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "/none/0.txt: cannot be read");
}

TEST(Oxts, APositionOutsideTheEarthIsNoFix) {
  const TemporaryFolder folder;
  const auto frame = read_oxts_file(folder.write("0.txt", oxts_record("91")), kBegin);
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->fix.valid);
}

/// East errors of fixes at one place, `period` seconds apart.
std::vector<double> errors(const FixDegradation& config, double period, int count) {
  FixError error(config);
  sensor::Fix fix{.stamp = kBegin, .position = geo_point_from_degrees(49, 8.4, 110)};
  const LocalFrame here(fix.position);
  std::vector<double> east;
  for (int k = 0; k < count; ++k, fix.stamp += from_seconds(period))
    east.push_back(here.to_enu(error.degraded(fix).position).x());
  return east;
}

double mean_product(const std::vector<double>& values, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t k = lag; k < values.size(); ++k) sum += values[k] * values[k - lag];
  return sum / static_cast<double>(values.size() - lag);
}

TEST(FixError, IsGaussMarkovOfTheGivenSigmaAndTime) {
  // One correlation time between fixes: neighbours share 1/e of the variance, those after next 1/e^2. The
  // mean of 20,000 such products scatters by 0.011 sigma^2.
  const std::vector<double> east = errors({.sigma = 2.0, .correlation_time = 30.0, .seed = 3}, 30.0, 20'000);
  EXPECT_NEAR(mean_product(east, 0) / 4.0, 1.0, 0.05);
  EXPECT_NEAR(mean_product(east, 1) / 4.0, std::exp(-1.0), 0.05);
  EXPECT_NEAR(mean_product(east, 2) / 4.0, std::exp(-2.0), 0.05);
}

TEST(FixError, StaysWithinAMomentAndIsDrawnAnewBySeed) {
  const std::vector<double> close = errors({.sigma = 2.0, .correlation_time = 60.0, .seed = 1}, 1e-6, 2);
  EXPECT_NEAR(close[1], close[0], 2e-3);
  EXPECT_NE(close[0], 0.0) << "the first error is of the stationary distribution";
  EXPECT_EQ(errors({.seed = 5}, 1.0, 4), errors({.seed = 5}, 1.0, 4));
  EXPECT_NE(errors({.seed = 5}, 1.0, 4), errors({.seed = 6}, 1.0, 4));
}

TEST(FixError, AFixThatIsNoneIsLeftWhereItIs) {
  FixError error({.sigma = 2.0});
  const sensor::Fix lost{.stamp = kBegin, .position = {}, .valid = false};
  const sensor::Fix out = error.degraded(lost);
  EXPECT_EQ(out.position, lost.position);
  EXPECT_FALSE(out.valid);
  EXPECT_EQ(out.covariance, 4.0 * Eigen::Matrix3d::Identity());
}

TEST(FixError, AStampThatGoesBackSpoilsNoLaterFix) {
  FixError error({.sigma = 2.0});
  sensor::Fix fix{.stamp = kBegin, .position = geo_point_from_degrees(49, 8.4, 110)};
  for (const int seconds : {2, 1, 3, 4}) {
    fix.stamp = kBegin + std::chrono::seconds(seconds);
    EXPECT_TRUE(is_valid(error.degraded(fix).position)) << seconds;
  }
}

}  // namespace
}  // namespace fleetmap::recording
