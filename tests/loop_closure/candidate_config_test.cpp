#include "fleetmap/loop_closure/candidate_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::loop_closure {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(CandidateConfig, DefaultsAreValid) { EXPECT_TRUE(CandidateConfig{}.validate()); }

TEST(CandidateConfig, ItsPartsAreChecked) {
  expect_refused(
      CandidateConfig{}, [](CandidateConfig& c) { c.proximity.radius_scale = 0.0; }, "radius_scale");
  expect_refused(
      CandidateConfig{}, [](CandidateConfig& c) { c.descriptors.kept = 0; }, "descriptor_match.kept");
}

TEST(CandidateConfig, DistancesAndInformationAreNotNegative) {
  expect_accepted(CandidateConfig{}, &CandidateConfig::max_sigma_m, {1e-6});
  expect_refused(CandidateConfig{}, &CandidateConfig::max_sigma_m, {0.0, -1.0, kNaN<double>}, "max_sigma_m");
  for (double CandidateConfig::*spacing : {&CandidateConfig::spacing_m, &CandidateConfig::spacing_aligned_m,
                                           &CandidateConfig::spacing_failed_m}) {
    expect_accepted(CandidateConfig{}, spacing, {0.0});
    expect_refused(CandidateConfig{}, spacing, {-0.1, kNaN<double>}, "loop_candidates.spacing");
  }
  expect_accepted(CandidateConfig{}, &CandidateConfig::min_information, {0.0});
  expect_refused(CandidateConfig{}, &CandidateConfig::min_information, {-0.1, kNaN<double>},
                 "loop_candidates.min_");
}

TEST(CandidateConfig, TimesAreBounded) {
  for (Duration CandidateConfig::*time : {&CandidateConfig::max_wait, &CandidateConfig::retry_after}) {
    expect_accepted(CandidateConfig{}, time, {Duration::zero()});
    expect_refused(CandidateConfig{}, time, {Duration{-1}}, "retry_after");
  }
  for (Duration CandidateConfig::*time : {&CandidateConfig::peer_timeout, &CandidateConfig::match_period}) {
    expect_accepted(CandidateConfig{}, time, {Duration{1}});
    expect_refused(CandidateConfig{}, time, {Duration::zero(), Duration{-1}},
                   "peer_timeout and match_period");
  }
}

TEST(CandidateConfig, CountsAreBounded) {
  for (std::size_t CandidateConfig::*count : {&CandidateConfig::max_active, &CandidateConfig::max_waiting}) {
    expect_accepted(CandidateConfig{}, count, {1});
    expect_refused(CandidateConfig{}, count, {0}, "max_active and max_waiting");
  }
  expect_accepted(CandidateConfig{}, &CandidateConfig::max_attempts, {1});
  expect_refused(CandidateConfig{}, &CandidateConfig::max_attempts, {0, -1}, "max_attempts");
  expect_accepted(CandidateConfig{}, &CandidateConfig::match_repeats, {0});
  expect_refused(CandidateConfig{}, &CandidateConfig::match_repeats, {-1}, "match_repeats");
}

}  // namespace
}  // namespace fleetmap::loop_closure
