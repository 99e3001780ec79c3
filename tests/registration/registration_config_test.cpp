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

TEST(RegistrationConfig, DefaultsAreValid) { EXPECT_TRUE(RegistrationConfig{}.validate()); }

TEST(RegistrationConfig, LengthsAndAnglesAreBounded) {
  struct Range {
    float RegistrationConfig::*value;
    float low, high;
    const char* name;
  };
  for (const Range& range : {Range{&RegistrationConfig::max_range_m, 5.0f, 200.0f, "max_range_m"},
                             {&RegistrationConfig::surfel_m, 0.1f, 2.0f, "surfel_m"},
                             {&RegistrationConfig::cell_m, 0.2f, 5.0f, "cell_m"},
                             {&RegistrationConfig::yaw_step_rad, 0.002f, 0.5f, "yaw_step_rad"},
                             {&RegistrationConfig::max_search_m, 1.0f, 200.0f, "max_search_m"},
                             {&RegistrationConfig::patch_m, 1.0f, 50.0f, "patch_m"}}) {
    expect_accepted(RegistrationConfig{}, range.value, {range.low, range.high});
    expect_refused(RegistrationConfig{}, range.value, {0.99f * range.low, 1.01f * range.high, kNaN<float>},
                   range.name);
  }
  for (const auto& [field, name] : {std::pair{&RegistrationConfig::voxel_m, "voxel_m"},
                                    {&RegistrationConfig::inlier_m, "inlier_m"},
                                    {&RegistrationConfig::misfit_m, "misfit_m"}}) {
    expect_refused(RegistrationConfig{}, field, {0.0f, -1.0f, kNaN<float>}, name);
  }
}

TEST(RegistrationConfig, SharesAndWeightsAreBounded) {
  expect_refused(RegistrationConfig{}, &RegistrationConfig::prior_sigmas, {0.0, -1.0, kNaN<double>},
                 "prior_sigmas");
  expect_accepted(RegistrationConfig{}, &RegistrationConfig::min_overlap, {0.01, 1.0});
  expect_refused(RegistrationConfig{}, &RegistrationConfig::min_overlap, {0.0, 1.01, kNaN<double>},
                 "min_overlap");
  expect_refused(RegistrationConfig{}, &RegistrationConfig::max_excess, {0.0, -1.0, kNaN<double>},
                 "max_excess");
  // At most one of two modes may be accepted.
  expect_accepted(RegistrationConfig{}, &RegistrationConfig::min_weight, {0.501, 0.9999});
  expect_refused(RegistrationConfig{}, &RegistrationConfig::min_weight, {0.5, 1.0, kNaN<double>},
                 "min_weight");
}

TEST(RegistrationConfig, CountsAreBounded) {
  struct Count {
    std::size_t RegistrationConfig::*value;
    std::size_t min;
    const char* name;
  };
  for (const Count& count : {Count{&RegistrationConfig::max_candidates, 1, "max_candidates"},
                             {&RegistrationConfig::max_modes, 1, "max_modes"},
                             {&RegistrationConfig::coarse_points, 10, "coarse_points"},
                             {&RegistrationConfig::fine_points, 10, "fine_points"}}) {
    expect_accepted(RegistrationConfig{}, count.value, {count.min});
    expect_refused(RegistrationConfig{}, count.value, {count.min - 1}, count.name);
  }
}

TEST(RegistrationConfig, ItsPartsAreCheckedAndNamed) {
  expect_refused(
      RegistrationConfig{}, [](RegistrationConfig& c) { c.paper.max_rmse_m = 0.0; },
      "registration paper.max_rmse");
  expect_refused(
      RegistrationConfig{}, [](RegistrationConfig& c) { c.icp.kernels_m.clear(); },
      "registration: icp kernels_m");
}

TEST(RegistrationConfig, MethodsHaveTheNamesOfTheConfiguration) {
  EXPECT_STREQ(to_string(Method::correlation), "correlation");
  EXPECT_STREQ(to_string(Method::paper), "paper");
}

}  // namespace
}  // namespace fleetmap::registration
