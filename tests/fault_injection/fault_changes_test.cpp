#include "fault_changes.hpp"

#include <gtest/gtest.h>

namespace fleetmap::fault_injection {
namespace {

using std::chrono::seconds;
using Kind = FaultChange::Kind;

Fault fault(FaultKind kind, int begin, int length, double value = 0.0) {
  Fault fault;
  fault.kind = kind;
  fault.begin = seconds(begin);
  fault.length = seconds(length);
  fault.value = value;
  return fault;
}

TEST(FaultChanges, ComeInTheOrderOfTimeAndEndWithTheMapping) {
  Scenario scenario;
  scenario.mapping = seconds(100);
  scenario.faults = {fault(FaultKind::kCrash, 30, 10), fault(FaultKind::kOldStore, 35, 500, 20.0)};
  const auto changes = changes_of(scenario);
  ASSERT_EQ(changes.size(), 5u);
  const std::vector<std::tuple<Duration, std::size_t, Kind>> expected = {{seconds(15), 1, Kind::kBackup},
                                                                         {seconds(30), 0, Kind::kBegin},
                                                                         {seconds(35), 1, Kind::kBegin},
                                                                         {seconds(40), 0, Kind::kEnd},
                                                                         {seconds(100), 1, Kind::kEnd}};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(std::tuple(changes[k].at, changes[k].fault, changes[k].kind), expected[k]) << k;
  }
}

TEST(FaultChanges, ChangesAtOneMomentKeepTheOrderOfTheFaults) {
  Scenario scenario;
  scenario.mapping = seconds(100);
  scenario.faults = {fault(FaultKind::kLoss, 10, 5), fault(FaultKind::kDelay, 15, 5)};
  const auto changes = changes_of(scenario);
  EXPECT_EQ(changes[1].kind, Kind::kEnd);
  EXPECT_EQ(changes[2].kind, Kind::kBegin);
}

}  // namespace
}  // namespace fleetmap::fault_injection
