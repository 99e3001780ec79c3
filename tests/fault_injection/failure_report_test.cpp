#include "fleetmap/fault_injection/failure_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::fault_injection {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Scenario three_faults() {
  Scenario scenario;
  scenario.seed = 42;
  scenario.robots = 3;
  for (const double value : {1.0, 2.0, 3.0}) {
    Fault fault;
    fault.value = value;
    scenario.faults.push_back(fault);
  }
  return scenario;
}

TEST(FailureReport, AScenarioKeepsTheChosenFaultsInTheirOrder) {
  const Scenario scenario = with_faults(three_faults(), {0, 2});
  ASSERT_EQ(scenario.faults.size(), 2u);
  EXPECT_EQ(scenario.faults[0].value, 1.0);
  EXPECT_EQ(scenario.faults[1].value, 3.0);
  EXPECT_EQ(scenario.seed, 42u);
  EXPECT_THROW(with_faults(three_faults(), {3}), std::out_of_range);
}

TEST(FailureReport, NamesSeedAndViolations) {
  Outcome outcome;
  const Violation violation{*parse_invariants("all")->begin(), std::chrono::seconds(12), "r2", "a reason"};
  outcome.violations.push_back(violation);
  EXPECT_THAT(failure_report(three_faults(), outcome, {}, false),
              AllOf(HasSubstr("seed 42, 3 robots:"), HasSubstr("violates " + to_string(violation)),
                    Not(HasSubstr("--replay"))));
}

}  // namespace
}  // namespace fleetmap::fault_injection
