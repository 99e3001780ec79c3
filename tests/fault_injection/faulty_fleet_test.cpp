#include "faulty_fleet.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using namespace std::chrono_literals;

Outcome run_with(std::vector<Fault> faults, Duration mapping = 60s) {
  const testing::TemporaryFolder folder;
  const Scenario scenario{5, 3, mapping, std::move(faults)};
  RunConfig config;
  config.invariants = parse_invariants("all").value();
  config.trace = true;
  return FaultyFleet(scenario, config, folder / "").run();
}

Fault fault_of(FaultKind kind, std::size_t robot, double value = 0.0) {
  Fault fault;
  fault.kind = kind;
  fault.begin = 25s;
  fault.length = 10s;
  fault.robots = {robot};
  fault.value = value;
  return fault;
}

std::ptrdiff_t lines_with(const Outcome& outcome, const std::string& text) {
  return std::ranges::count_if(outcome.trace,
                               [&](const std::string& line) { return line.find(text) != line.npos; });
}

void expect_kept(const Outcome& outcome) {
  for (const Violation& violation : outcome.violations) ADD_FAILURE() << to_string(violation);
  EXPECT_GT(outcome.nodes, 10u);
}

TEST(FaultyFleet, WithoutFaultsEachRobotStartsOnceAndAllConverge) {
  const Outcome outcome = run_with({});
  expect_kept(outcome);
  for (const char* robot : {"r1", "r2", "r3"})
    EXPECT_EQ(lines_with(outcome, std::string(robot) + " starts in session"), 1) << robot;
  EXPECT_GT(outcome.alignments, 0u);
  EXPECT_LT(outcome.converged_after, 3min);
}

TEST(FaultyFleet, ACrashedRobotStartsAgainWithItsNodesAndTheOthersGoOn) {
  const Outcome outcome = run_with({fault_of(FaultKind::kCrash, 1)});
  expect_kept(outcome);
  EXPECT_EQ(lines_with(outcome, "r2 starts in session"), 2);
  EXPECT_EQ(lines_with(outcome, "r1 starts in session"), 1);
  EXPECT_EQ(lines_with(outcome, "with 0 nodes"), 3)
      << "three first starts are on empty stores, the fourth is not";
}

TEST(FaultyFleet, ALostStoreIsFilledAgainByTheOthers) {
  const Outcome outcome = run_with({fault_of(FaultKind::kLostStore, 1)});
  expect_kept(outcome);
  EXPECT_EQ(lines_with(outcome, "with 0 nodes"), 4) << "three first starts and that on the empty disk";
}

TEST(FaultyFleet, TwoFaultsThatStopARobotEndWithTheLast) {
  Fault crash = fault_of(FaultKind::kCrash, 1), step = fault_of(FaultKind::kClockStep, 1, 3600.0);
  step.begin = 30s;
  step.length = 20s;
  const Outcome outcome = run_with({crash, step}, 80s);
  expect_kept(outcome);
  EXPECT_EQ(lines_with(outcome, "r2 starts in session"), 2) << "not between the two ends";
}

TEST(FaultyFleet, TheTraceTellsWhenAFaultBeginsAndEnds) {
  const Fault fault = fault_of(FaultKind::kFullDisk, 0);
  const Outcome outcome = run_with({fault});
  expect_kept(outcome);
  EXPECT_EQ(lines_with(outcome, "ends: " + to_string(fault)), 1);
  EXPECT_EQ(lines_with(outcome, to_string(fault)), 2);
  EXPECT_EQ(lines_with(outcome, "the last fault has ended"), 1);
}

}  // namespace
}  // namespace fleetmap::fault_injection
