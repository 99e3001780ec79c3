#include "fleetmap/cloud/ground_config.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(GroundConfig, DefaultsAreValid) { EXPECT_TRUE(GroundConfig{}.validate()); }

TEST(GroundConfig, UpIsADirection) {
  expect_accepted(GroundConfig{}, &GroundConfig::up,
                  {Eigen::Vector3f(0.0f, 0.0f, 1e-3f), Eigen::Vector3f(3.0f, 0.0f, 9.0f)});
  expect_refused(GroundConfig{}, &GroundConfig::up,
                 {Eigen::Vector3f::Zero(), Eigen::Vector3f(0.0f, kNaN<float>, 1.0f)}, "up");
}

TEST(GroundConfig, LengthsAndAnglesAreBounded) {
  expect_accepted(GroundConfig{}, &GroundConfig::cell_m, {0.05f, 100.0f});
  expect_refused(GroundConfig{}, &GroundConfig::cell_m, {0.04f, 101.0f, kNaN<float>}, "cell_m");
  expect_refused(GroundConfig{}, &GroundConfig::thickness_m, {0.0f, -1.0f, kNaN<float>}, "thickness_m");
  expect_refused(GroundConfig{}, &GroundConfig::step_m, {0.0f, -1.0f, kNaN<float>}, "step_m");
  expect_accepted(GroundConfig{}, &GroundConfig::max_slope_rad, {0.01f, 1.49f});
  expect_refused(GroundConfig{}, &GroundConfig::max_slope_rad, {0.0f, 1.5f, kNaN<float>}, "max_slope_rad");
  expect_accepted(GroundConfig{}, &GroundConfig::max_slope_change_rad, {0.0f, 1.49f});
  expect_refused(GroundConfig{}, &GroundConfig::max_slope_change_rad, {-0.1f, 1.5f, kNaN<float>},
                 "max_slope_change_rad");
  expect_accepted(GroundConfig{}, &GroundConfig::min_area_m2, {0.0f});
  expect_refused(GroundConfig{}, &GroundConfig::min_area_m2, {-0.1f, kNaN<float>}, "min_area_m2");
}

}  // namespace
}  // namespace fleetmap::cloud
