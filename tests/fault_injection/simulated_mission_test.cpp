#include "simulated_mission.hpp"

#include <gtest/gtest.h>

#include "fault_injection/three_robots.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;

const Stamp kStart = stamp_from_ns(1'700'000'000'000'000'000);

class SimulatedMissionTest : public ::testing::Test {
 protected:
  SimulatedMissionTest() {
    for (const AgentId& name : kFleet) mission_.start(name);
  }
  /// One second of all, who hear each other.
  void drive(int seconds) {
    for (int k = 0; k < seconds; ++k) {
      now_ += std::chrono::seconds(1);
      for (const AgentId& name : kFleet) mission_.drive(name, 1.0, now_);
      for (const AgentId& from : kFleet)
        for (const AgentId& to : kFleet)
          if (from != to) mission_.on_report(to, mission_.report(from), now_);
    }
  }

  SimulatedMission mission_{kFleet};
  Stamp now_ = kStart;
};

TEST_F(SimulatedMissionTest, RobotsDriveAllTheirRowsAndCountNoneBefore) {
  EXPECT_EQ(mission_.report(agent("r1")).done.count(), 0u);
  for (int k = 0; k < 300 && mission_.report(agent("r1")).done.count() < 6; ++k) {
    drive(1);
    for (const AgentId& name : kFleet) EXPECT_EQ(mission_.skipped_row(name, std::nullopt), std::nullopt);
  }
  EXPECT_EQ(mission_.report(agent("r1")).done.count(), 6u);
}

TEST_F(SimulatedMissionTest, AFalseReportClaimsAllRowsAndCountsForTheRowsOfItsMakerAlone) {
  drive(2);
  const auto report = mission_.false_report(agent("r3"), now_ + std::chrono::seconds(1));
  EXPECT_EQ(report.done.count(), 6u);
  mission_.on_report(agent("r1"), report, now_);
  mission_.drive(agent("r1"), 0.0, now_ + std::chrono::seconds(1));
  EXPECT_EQ(mission_.skipped_row(agent("r1"), agent("r3")), std::nullopt);
  EXPECT_TRUE(mission_.skipped_row(agent("r1"), std::nullopt)) << "rows of r3, on its word";
}

}  // namespace
}  // namespace fleetmap::fault_injection
