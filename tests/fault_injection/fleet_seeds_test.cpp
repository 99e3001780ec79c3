#include <gtest/gtest.h>

#include "fleetmap/fault_injection/fleet_run.hpp"

namespace fleetmap::fault_injection {
namespace {

/// 100 seeds in four tests, which run beside each other.
class FleetSeeds : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(FleetSeeds, keeps_its_invariants_whatever_fails) {
  ScenarioConfig scenarios;
  scenarios.max_robots = 5;
  scenarios.mapping = std::chrono::seconds(80);
  scenarios.kinds = parse_fault_kinds("all").value();
  RunConfig config;
  config.invariants = parse_invariants("all").value();
  std::size_t nodes = 0, alignments = 0;
  for (std::uint64_t seed = GetParam(); seed < GetParam() + 25; ++seed) {
    const Scenario scenario = make_scenario(seed, scenarios);
    const Outcome outcome = run(scenario, config);
    nodes += outcome.nodes;
    alignments += outcome.alignments;
    for (const Violation& violation : outcome.violations)
      ADD_FAILURE() << "seed " << seed << ": " << to_string(violation);
  }
  EXPECT_GT(nodes, 500u);
  EXPECT_GT(alignments, 50u);
}
INSTANTIATE_TEST_SUITE_P(Seeds, FleetSeeds, ::testing::Values(1, 26, 51, 76));

}  // namespace
}  // namespace fleetmap::fault_injection
