#include "fleetmap/registration/icp_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::registration {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = IcpConfig;

TEST(IcpConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(IcpConfig, ThereIsAStageAndEachHasAKernel) {
  expect_accepted(Config{}, &Config::kernels_m, {{0.1f}});
  expect_refused(Config{}, &Config::kernels_m, {{}, {0.5f, 0.0f}, {-0.1f}, {kNaN<float>}}, "kernels_m");
  expect_accepted(Config{}, &Config::iterations_per_stage, {1});
  expect_refused(Config{}, &Config::iterations_per_stage, {0, -1}, "iterations_per_stage");
}

TEST(IcpConfig, BoundsOfTheCovarianceArePositive) {
  for (const auto& [field, name] : {std::pair{&Config::max_stddev_m, "max_stddev_m"},
                                    {&Config::min_stddev_m, "min_stddev_m"},
                                    {&Config::min_stddev_rad, "min_stddev_rad"}}) {
    expect_accepted(Config{}, field, {1e-9});
    expect_refused(Config{}, field, {0.0, -1.0, kNaN<double>}, name);
  }
}

}  // namespace
}  // namespace fleetmap::registration
