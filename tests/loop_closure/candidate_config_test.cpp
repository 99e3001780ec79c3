#include "fleetmap/loop_closure/candidate_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::loop_closure {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = CandidateConfig;

TEST(CandidateConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(CandidateConfig, ItsPartsAreChecked) {
  expect_refused(
      Config{}, [](Config& c) { c.proximity.radius_scale = 0.0; }, "radius_scale");
  expect_refused(
      Config{}, [](Config& c) { c.descriptors.kept = 0; }, "descriptor_match.kept");
}

TEST(CandidateConfig, DistancesAndInformationAreNotNegative) {
  expect_accepted(Config{}, &Config::max_sigma_m, {1e-6});
  expect_refused(Config{}, &Config::max_sigma_m, {0.0, -1.0, kNaN<double>}, "max_sigma_m");
  for (double Config::*spacing :
       {&Config::spacing_m, &Config::spacing_aligned_m, &Config::spacing_failed_m}) {
    expect_accepted(Config{}, spacing, {0.0});
    expect_refused(Config{}, spacing, {-0.1, kNaN<double>}, "loop_candidates.spacing");
  }
  expect_accepted(Config{}, &Config::min_information, {0.0});
  expect_refused(Config{}, &Config::min_information, {-0.1, kNaN<double>}, "loop_candidates.min_");
}

TEST(CandidateConfig, TimesAreBounded) {
  for (Duration Config::*time : {&Config::max_wait, &Config::retry_after}) {
    expect_accepted(Config{}, time, {Duration::zero()});
    expect_refused(Config{}, time, {Duration{-1}}, "retry_after");
  }
  for (Duration Config::*time : {&Config::peer_timeout, &Config::match_period}) {
    expect_accepted(Config{}, time, {Duration{1}});
    expect_refused(Config{}, time, {Duration::zero(), Duration{-1}}, "peer_timeout and match_period");
  }
}

TEST(CandidateConfig, CountsAreBounded) {
  for (std::size_t Config::*count : {&Config::max_active, &Config::max_waiting}) {
    expect_accepted(Config{}, count, {1});
    expect_refused(Config{}, count, {0}, "max_active and max_waiting");
  }
  expect_accepted(Config{}, &Config::max_attempts, {1});
  expect_refused(Config{}, &Config::max_attempts, {0, -1}, "max_attempts");
  expect_accepted(Config{}, &Config::match_repeats, {0});
  expect_refused(Config{}, &Config::match_repeats, {-1}, "match_repeats");
}

}  // namespace
}  // namespace fleetmap::loop_closure
