#include "fleetmap/registration/prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace fleetmap::registration {
namespace {

using Eigen::Vector3d;

/// Two sigmas are 10 m, 0.4 rad, 0.2 rad and 20 m.
bool within_two(const Prior& prior, const Pose& T) { return agrees(prior, T, 2.0); }

Pose shifted(const Pose& T, const Vector3d& by) {
  return make_pose(Eigen::Matrix3d(T.linear()), Vector3d(T.translation() + by));
}

Pose turned(const Pose& T, double roll, double pitch, double yaw) {
  return make_pose(Eigen::Matrix3d(rotation_from_rpy(roll, pitch, yaw) * T.linear()),
                   Vector3d(T.translation()));
}

TEST(Prior, AgreesUpToSoManySigmasOfEachKind) {
  Prior prior;
  prior.T_target_source = make_pose(rotation_from_rpy(0.0, 0.0, 3.0), Vector3d(100, -50, 3));
  const Pose T = prior.T_target_source;
  EXPECT_TRUE(within_two(prior, T));
  EXPECT_TRUE(within_two(prior, shifted(T, {9.9, 0, 0})));
  EXPECT_FALSE(within_two(prior, shifted(T, {0, -10.1, 0})));
  EXPECT_FALSE(within_two(prior, shifted(T, {8, 8, 0}))) << "the norm counts";
  EXPECT_TRUE(within_two(prior, shifted(T, {0, 0, 19.9})));
  EXPECT_FALSE(within_two(prior, shifted(T, {0, 0, -20.1})));
  EXPECT_TRUE(within_two(prior, turned(T, 0, 0, 0.39))) << "across the half turn";
  EXPECT_FALSE(within_two(prior, turned(T, 0, 0, 0.41)));
  EXPECT_FALSE(within_two(prior, turned(T, 0, 0, -0.41)));
  EXPECT_TRUE(within_two(prior, turned(T, 0.19, 0, 0)));
  EXPECT_FALSE(within_two(prior, turned(T, 0.21, 0, 0)));
  EXPECT_FALSE(within_two(prior, turned(T, 0.15, 0.15, 0)));
  EXPECT_FALSE(agrees(prior, shifted(T, {9.9, 0, 0}), 1.9));
}

/// Height and heading are along and about the vertical, wherever it points in the target's frame.
TEST(Prior, HeightAndHeadingAreThoseOfTheVertical) {
  Prior prior;
  prior.T_target_source = make_pose(rotation_from_rpy(0.3, -0.2, 1.0), Vector3d(1, 2, 3));
  prior.up_target = 5.0 * Vector3d::UnitX();  // the target lies on its back
  const Pose T = prior.T_target_source;
  EXPECT_TRUE(within_two(prior, shifted(T, {19.9, 0, 0})));
  EXPECT_FALSE(within_two(prior, shifted(T, {0, 0, 10.1})));
  EXPECT_TRUE(within_two(prior, turned(T, 0.39, 0, 0)));
  EXPECT_FALSE(within_two(prior, turned(T, 0, 0, 0.21)));
  EXPECT_FALSE(within_two(prior, turned(T, 0, 0.21, 0)));
}

TEST(Prior, HalfATurnIsNoSmallOne) {
  const Prior prior;
  EXPECT_FALSE(within_two(prior, turned(Pose::Identity(), 0, 0, std::numbers::pi)));
  EXPECT_FALSE(within_two(prior, turned(Pose::Identity(), std::numbers::pi, 0, 0))) << "upside down";
}

TEST(Prior, NamesTheFieldThatBreaksItsRule) {
  EXPECT_TRUE(Prior{}.validate());
  using Change = std::function<void(Prior&)>;
  const double nan = std::nan("");
  const std::pair<Change, const char*> broken[] = {
      {[=](Prior& p) { p.T_target_source.translation().y() = nan; }, "prior pose must be finite"},
      {[](Prior& p) { p.sigma_translation_m = 0.0; }, "prior sigma_translation_m must be positive"},
      {[=](Prior& p) { p.sigma_translation_m = nan; }, "prior sigma_translation_m must be positive"},
      {[](Prior& p) { p.sigma_yaw_rad = -1.0; }, "prior sigma_yaw_rad must be positive"},
      {[](Prior& p) { p.sigma_tilt_rad = 0.0; }, "prior sigma_tilt_rad must be positive"},
      {[](Prior& p) { p.sigma_height_m = 0.0; }, "prior sigma_height_m must be positive"},
      {[](Prior& p) { p.up_target.setZero(); }, "prior up_target must be a finite vector other than zero"},
      {[=](Prior& p) { p.up_target.x() = nan; }, "prior up_target must be a finite vector other than zero"},
  };
  for (const auto& [change, text] : broken) {
    Prior prior;
    change(prior);
    const Status status = prior.validate();
    ASSERT_FALSE(status) << text;
    EXPECT_EQ(status.error().message, text);
  }
}

}  // namespace
}  // namespace fleetmap::registration
