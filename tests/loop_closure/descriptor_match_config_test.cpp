#include "fleetmap/loop_closure/descriptor_match_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::loop_closure {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = DescriptorMatchConfig;

TEST(DescriptorMatchConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(DescriptorMatchConfig, SimilaritiesAreShares) {
  for (const auto& [field, name] : {std::pair{&Config::min_similarity, "min_similarity"},
                                    {&Config::sure_similarity, "sure_similarity"}}) {
    expect_accepted(Config{}, field, {0.0, 1.0});
    expect_refused(Config{}, field, {-0.01, 1.01, kNaN<double>}, name);
  }
}

TEST(DescriptorMatchConfig, DistancesAndCountsAreBounded) {
  expect_accepted(Config{}, &Config::spacing_m, {0.0});
  expect_refused(Config{}, &Config::spacing_m, {-0.1, kNaN<double>}, "spacing_m");
  expect_accepted(Config{}, &Config::min_support, {0.0});
  expect_refused(Config{}, &Config::min_support, {-0.1, kNaN<double>}, "min_support");
  for (const auto& [field, name] :
       {std::pair{&Config::agree_m, "agree_m"}, {&Config::agree_rad, "agree_rad"}}) {
    expect_accepted(Config{}, field, {1e-6});
    expect_refused(Config{}, field, {0.0, -1.0, kNaN<double>}, name);
  }
  for (const auto& [field, name] :
       {std::pair{&Config::kept, "kept"}, {&Config::max_compared, "max_compared"}}) {
    expect_accepted(Config{}, field, {1});
    expect_refused(Config{}, field, {0}, name);
  }
}

}  // namespace
}  // namespace fleetmap::loop_closure
