#include "fleetmap/eval/map_metrics_config.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::eval {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = MapMetricsConfig;

TEST(MapMetricsConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(MapMetricsConfig, DistancesArePositive) {
  for (const auto& [field, name] : {std::pair{&Config::inlier_distance, "inlier_distance"},
                                    {&Config::density_radius, "density_radius"},
                                    {&Config::truth_reach, "truth_reach"},
                                    {&Config::resolution, "resolution"},
                                    {&Config::registration_distance, "registration_distance"},
                                    {&Config::min_noise, "min_noise"}}) {
    expect_refused(Config{}, field, {0.0, -1.0, kNaN<double>, kInfinity<double>}, name);
  }
}

TEST(MapMetricsConfig, ThresholdsAscendUpToTheInlierDistance) {
  using Thresholds = std::array<double, 3>;
  expect_accepted(Config{}, &Config::thresholds, {Thresholds{0.1, 0.1, 0.5}, Thresholds{0.01, 0.02, 0.03}});
  expect_refused(Config{}, &Config::thresholds, {Thresholds{0.2, 0.1, 0.3}, Thresholds{0.1, 0.3, 0.2}},
                 "ascend");
  expect_refused(Config{}, &Config::thresholds, {Thresholds{0.1, 0.2, 0.51}}, "inlier_distance");
  expect_refused(Config{}, &Config::thresholds, {Thresholds{0.0, 0.1, 0.2}}, "thresholds[0]");
  expect_refused(Config{}, &Config::thresholds, {Thresholds{0.1, 0.2, kNaN<double>}}, "thresholds[2]");
}

TEST(MapMetricsConfig, SamplesAreLargeEnoughForMeans) {
  for (const auto& [field, name] : {std::pair{&Config::max_truth, "max_truth"},
                                    {&Config::max_distances, "max_distances"},
                                    {&Config::max_densities, "max_densities"}}) {
    expect_accepted(Config{}, field, {1000});
    expect_refused(Config{}, field, {999, 0}, name);
  }
}

}  // namespace
}  // namespace fleetmap::eval
