#include "fleetmap/loop_closure/descriptor_match_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::loop_closure {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(DescriptorMatchConfig, DefaultsAreValid) { EXPECT_TRUE(DescriptorMatchConfig{}.validate()); }

TEST(DescriptorMatchConfig, SimilaritiesAreShares) {
  for (const auto& [field, name] : {std::pair{&DescriptorMatchConfig::min_similarity, "min_similarity"},
                                    {&DescriptorMatchConfig::sure_similarity, "sure_similarity"}}) {
    expect_accepted(DescriptorMatchConfig{}, field, {0.0, 1.0});
    expect_refused(DescriptorMatchConfig{}, field, {-0.01, 1.01, kNaN<double>}, name);
  }
}

TEST(DescriptorMatchConfig, DistancesAndCountsAreBounded) {
  expect_accepted(DescriptorMatchConfig{}, &DescriptorMatchConfig::spacing_m, {0.0});
  expect_refused(DescriptorMatchConfig{}, &DescriptorMatchConfig::spacing_m, {-0.1, kNaN<double>},
                 "spacing_m");
  expect_accepted(DescriptorMatchConfig{}, &DescriptorMatchConfig::min_support, {0.0});
  expect_refused(DescriptorMatchConfig{}, &DescriptorMatchConfig::min_support, {-0.1, kNaN<double>},
                 "min_support");
  for (const auto& [field, name] : {std::pair{&DescriptorMatchConfig::agree_m, "agree_m"},
                                    {&DescriptorMatchConfig::agree_rad, "agree_rad"}}) {
    expect_accepted(DescriptorMatchConfig{}, field, {1e-6});
    expect_refused(DescriptorMatchConfig{}, field, {0.0, -1.0, kNaN<double>}, name);
  }
  for (const auto& [field, name] : {std::pair{&DescriptorMatchConfig::kept, "kept"},
                                    {&DescriptorMatchConfig::max_compared, "max_compared"}}) {
    expect_accepted(DescriptorMatchConfig{}, field, {1});
    expect_refused(DescriptorMatchConfig{}, field, {0}, name);
  }
}

}  // namespace
}  // namespace fleetmap::loop_closure
