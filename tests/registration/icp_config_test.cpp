#include "fleetmap/registration/icp_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::registration {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(IcpConfig, DefaultsAreValid) { EXPECT_TRUE(IcpConfig{}.validate()); }

TEST(IcpConfig, ThereIsAStageAndEachHasAKernel) {
  expect_accepted(IcpConfig{}, &IcpConfig::kernels_m, {{0.1f}});
  expect_refused(IcpConfig{}, &IcpConfig::kernels_m, {{}, {0.5f, 0.0f}, {-0.1f}, {kNaN<float>}}, "kernels_m");
  expect_accepted(IcpConfig{}, &IcpConfig::iterations_per_stage, {1});
  expect_refused(IcpConfig{}, &IcpConfig::iterations_per_stage, {0, -1}, "iterations_per_stage");
}

TEST(IcpConfig, BoundsOfTheCovarianceArePositive) {
  for (const auto& [field, name] : {std::pair{&IcpConfig::max_stddev_m, "max_stddev_m"},
                                    {&IcpConfig::min_stddev_m, "min_stddev_m"},
                                    {&IcpConfig::min_stddev_rad, "min_stddev_rad"}}) {
    expect_accepted(IcpConfig{}, field, {1e-9});
    expect_refused(IcpConfig{}, field, {0.0, -1.0, kNaN<double>}, name);
  }
}

}  // namespace
}  // namespace fleetmap::registration
