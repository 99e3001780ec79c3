#include "fleetmap/registration/registration_config.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::registration {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = RegistrationConfig;

TEST(RegistrationConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(RegistrationConfig, LengthsAndAnglesAreBounded) {
  struct Range {
    float Config::*value;
    float low, high;
    const char* name;
  };
  for (const Range& range : {Range{&Config::max_range_m, 5.0f, 200.0f, "max_range_m"},
                             {&Config::surfel_m, 0.1f, 2.0f, "surfel_m"},
                             {&Config::cell_m, 0.2f, 5.0f, "cell_m"},
                             {&Config::yaw_step_rad, 0.002f, 0.5f, "yaw_step_rad"},
                             {&Config::max_search_m, 1.0f, 200.0f, "max_search_m"},
                             {&Config::patch_m, 1.0f, 50.0f, "patch_m"}}) {
    expect_accepted(Config{}, range.value, {range.low, range.high});
    expect_refused(Config{}, range.value, {0.99f * range.low, 1.01f * range.high, kNaN<float>}, range.name);
  }
  for (const auto& [field, name] : {std::pair{&Config::voxel_m, "voxel_m"},
                                    {&Config::inlier_m, "inlier_m"},
                                    {&Config::misfit_m, "misfit_m"}}) {
    expect_refused(Config{}, field, {0.0f, -1.0f, kNaN<float>}, name);
  }
}

TEST(RegistrationConfig, SharesAndWeightsAreBounded) {
  expect_refused(Config{}, &Config::prior_sigmas, {0.0, -1.0, kNaN<double>}, "prior_sigmas");
  expect_accepted(Config{}, &Config::min_overlap, {0.01, 1.0});
  expect_refused(Config{}, &Config::min_overlap, {0.0, 1.01, kNaN<double>}, "min_overlap");
  expect_refused(Config{}, &Config::max_excess, {0.0, -1.0, kNaN<double>}, "max_excess");
  // At most one of two modes may be accepted.
  expect_accepted(Config{}, &Config::min_weight, {0.501, 0.9999});
  expect_refused(Config{}, &Config::min_weight, {0.5, 1.0, kNaN<double>}, "min_weight");
}

TEST(RegistrationConfig, CountsAreBounded) {
  struct Count {
    std::size_t Config::*value;
    std::size_t min;
    const char* name;
  };
  for (const Count& count : {Count{&Config::max_candidates, 1, "max_candidates"},
                             {&Config::max_modes, 1, "max_modes"},
                             {&Config::coarse_points, 10, "coarse_points"},
                             {&Config::fine_points, 10, "fine_points"}}) {
    expect_accepted(Config{}, count.value, {count.min});
    expect_refused(Config{}, count.value, {count.min - 1}, count.name);
  }
}

TEST(RegistrationConfig, ItsPartsAreCheckedAndNamed) {
  expect_refused(
      Config{}, [](Config& c) { c.paper.max_rmse_m = 0.0; }, "registration paper.max_rmse");
  expect_refused(
      Config{}, [](Config& c) { c.icp.kernels_m.clear(); }, "registration: icp kernels_m");
}

TEST(RegistrationConfig, MethodsHaveTheNamesOfTheConfiguration) {
  EXPECT_STREQ(to_string(Method::correlation), "correlation");
  EXPECT_STREQ(to_string(Method::paper), "paper");
}

}  // namespace
}  // namespace fleetmap::registration
