#include "fleetmap/fault_injection/fleet_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fault_injection/checked_runs.hpp"

namespace fleetmap::fault_injection {
namespace {

ScenarioConfig small_fleets(const char* faults) {
  ScenarioConfig config;
  config.max_robots = 5;
  config.mapping = std::chrono::seconds(80);
  config.kinds = parse_fault_kinds(faults).value();
  return config;
}

/// With signed items, forged ones and those that a liar alters not even cost a name.
TEST(FleetRun, keeps_its_invariants_whatever_fails_where_items_are_signed) {
  RunConfig config = checking("all");
  config.signatures = true;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Outcome outcome = run(make_scenario(seed, small_fleets("all")), config);
    for (const Violation& violation : outcome.violations)
      ADD_FAILURE() << "seed " << seed << ": " << to_string(violation);
  }
}

/// A compromised robot that pulls others along leaves an honest one that contradicts them all.
TEST(FleetRun, does_not_blame_the_honest_robot_that_was_not_pulled_along) {
  ScenarioConfig config;
  config.max_robots = 10;
  config.kinds = parse_fault_kinds("compromised").value();
  for (const std::uint64_t seed : {18u, 12u, 35u}) {
    const Outcome outcome = run(make_scenario(seed, config), checking("named,truth"));
    for (const Violation& violation : outcome.violations)
      ADD_FAILURE() << "seed " << seed << ": " << to_string(violation);
    EXPECT_GT(outcome.alignments, 40u) << "seed " << seed;
  }
}

TEST(FleetRun, replays_a_seed_packet_by_packet) {
  const Scenario scenario = make_scenario(7, small_fleets("all"));
  const Outcome first = run(scenario, checking("all")), second = run(scenario, checking("all"));
  EXPECT_GT(first.packets, 100u);
  EXPECT_EQ(first.packets, second.packets);
  EXPECT_EQ(first.fingerprint, second.fingerprint);
  EXPECT_NE(first.fingerprint, run(make_scenario(8, small_fleets("all")), checking("all")).fingerprint);
}

TEST(FleetRun, does_not_converge_in_less_time_than_a_partition_lasts) {
  // Shows that the check of the fleet can fail.
  Scenario scenario{1, 3, std::chrono::seconds(40), {}};
  Fault partition;
  partition.kind = FaultKind::kPartition;
  partition.length = std::chrono::seconds(40);
  partition.robots = {0};
  scenario.faults = {partition};
  RunConfig config = checking("converges");
  config.convergence_timeout = std::chrono::milliseconds(50);
  const Outcome outcome = run(scenario, config);
  ASSERT_EQ(outcome.violations.size(), 1u);
  EXPECT_EQ(outcome.violations[0].invariant, Invariant::kConverges);
}

TEST(Scenario, is_a_function_of_its_seed_within_its_bounds) {
  const ScenarioConfig config = small_fleets("crash,loss,one_way");
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scenario scenario = make_scenario(seed, config), again = make_scenario(seed, config);
    ASSERT_EQ(scenario.faults.size(), again.faults.size());
    EXPECT_TRUE(std::ranges::is_sorted(scenario.faults, {}, &Fault::begin));
    for (std::size_t k = 0; k < scenario.faults.size(); ++k) {
      EXPECT_EQ(to_string(scenario.faults[k]), to_string(again.faults[k]));
      EXPECT_TRUE(config.kinds.contains(scenario.faults[k].kind));
      for (const std::size_t robot : scenario.faults[k].robots) EXPECT_LT(robot, scenario.robots);
    }
  }
}

TEST(Scenario, names_of_faults_and_invariants_are_read_back) {
  EXPECT_EQ(parse_fault_kinds("all").value().size(), kFaultKinds);
  EXPECT_EQ(parse_invariants("all").value().size(), kInvariants);
  EXPECT_EQ(parse_fault_kinds("crash,liar").value(), (std::set{FaultKind::kCrash, FaultKind::kLiar}));
  EXPECT_FALSE(parse_fault_kinds("crash,gremlin"));
}

}  // namespace
}  // namespace fleetmap::fault_injection
