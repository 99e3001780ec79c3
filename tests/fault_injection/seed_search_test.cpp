#include "fleetmap/fault_injection/seed_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fault_injection/checked_runs.hpp"
#include "fleetmap/fault_injection/fleet_run.hpp"

namespace fleetmap::fault_injection {
namespace {

using ::testing::UnorderedElementsAreArray;

ScenarioConfig fleets_of_three() {
  ScenarioConfig config;
  config.max_robots = 3;
  config.mapping = std::chrono::seconds(30);
  return config;
}

TEST(SeedSearch, TotalsAreThoseOfTheRunsHoweverManyRunAtATime) {
  const RunConfig config = checking("all");
  SeedTotals expected;
  for (std::uint64_t seed = 5; seed < 8; ++seed) {
    const Outcome outcome = run(make_scenario(seed, fleets_of_three()), config);
    expected.longest_s = std::max(expected.longest_s, to_seconds(outcome.converged_after));
    expected.max_bytes_per_second = std::max(expected.max_bytes_per_second, outcome.max_bytes_per_second);
    expected.nodes += outcome.nodes;
    expected.packets += outcome.packets;
    expected.failed += !outcome.violations.empty();
  }
  ASSERT_GT(expected.packets, 100u);
  for (const unsigned jobs : {1u, 3u}) {
    std::size_t reports = 0;
    const SeedTotals totals = try_seeds({.first = 5, .count = 3, .jobs = jobs, .shrinks = false},
                                        fleets_of_three(), config, [&](const std::string&) { ++reports; });
    EXPECT_EQ(totals.nodes, expected.nodes) << jobs;
    EXPECT_EQ(totals.packets, expected.packets) << jobs;
    EXPECT_EQ(totals.longest_s, expected.longest_s) << jobs;
    EXPECT_EQ(totals.max_bytes_per_second, expected.max_bytes_per_second) << jobs;
    EXPECT_EQ(totals.failed, expected.failed) << jobs;
    EXPECT_EQ(reports, expected.failed) << jobs;
  }
}

/// Some fleets do not converge if they have no time to.
TEST(SeedSearch, EachFailureIsReportedWithItsSeed) {
  RunConfig config = checking("converges");
  config.convergence_timeout = std::chrono::milliseconds(1);
  ScenarioConfig scenarios = fleets_of_three();
  scenarios.kinds = parse_fault_kinds("partition").value();
  std::vector<std::string> expected, reports;
  for (std::uint64_t seed = 11; seed < 15; ++seed) {
    if (!run(make_scenario(seed, scenarios), config).violations.empty())
      expected.push_back("seed " + std::to_string(seed) + ", 3 robots:");
  }
  ASSERT_FALSE(expected.empty());
  const SeedTotals totals = try_seeds(
      {.first = 11, .count = 4, .jobs = 2, .shrinks = false}, scenarios, config,
      [&](const std::string& report) { reports.push_back(report.substr(0, report.find(':') + 1)); });
  EXPECT_EQ(totals.failed, expected.size());
  EXPECT_THAT(reports, UnorderedElementsAreArray(expected));
}

}  // namespace
}  // namespace fleetmap::fault_injection
