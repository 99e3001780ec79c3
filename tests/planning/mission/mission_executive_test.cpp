#include "fleetmap/planning/mission/mission_executive.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/mission/virtual_fleet.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::kLimit;
using testing::kLoss;
using testing::VirtualFleet;

std::shared_ptr<const FleetPlan> executive_plan(int robots, bool mixed = false) {
  testing::SiteSpec spec;
  spec.width = spec.depth = 120.0;
  spec.missing = 0.1;
  MissionConfig config;
  config.division.search_rounds = 30;
  auto plan = plan_fleet(testing::site(spec), testing::fleet(robots, mixed), config);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
  return *plan;
}

void expect_all_driven(const VirtualFleet& fleet) {
  EXPECT_EQ(fleet.rows_driven(), fleet.plan->mission.rows.size());
}

void expect_at_the_meeting(const VirtualFleet& fleet) {
  for (const VirtualFleet::Robot& robot : fleet.robots) {
    if (!robot.executive) continue;
    EXPECT_EQ(robot.state, MissionState::kDone);
    EXPECT_LT((robot.pose.position - fleet.plan->meeting->place).norm(), 0.5 * 90.0);
  }
}

TEST(MissionExecutive, AFleetWithoutTroubleDrivesItsPlan) {
  for (int robots = 2; robots <= 5; ++robots) {
    VirtualFleet fleet(executive_plan(robots), kLoss, 7);
    const double time = fleet.run(kLimit);
    expect_all_driven(fleet);
    expect_at_the_meeting(fleet);
    EXPECT_LT(time, 1.3 * fleet.plan->division.makespan + 60.0) << robots;
    for (const auto& robot : fleet.robots) EXPECT_EQ(robot.executive->status().lost.size(), 0u);
  }
}

TEST(MissionExecutive, TheRowsOfAKilledRobotAreTakenOver) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const int robots = 2 + static_cast<int>(seed % 4);
    VirtualFleet fleet(executive_plan(robots), kLoss, seed);
    const std::size_t victim = seed % static_cast<std::size_t>(robots);
    fleet.run(kLimit, [&] {
      if (fleet.now == 100.0) fleet.kill(victim);
    });
    expect_all_driven(fleet);
    expect_at_the_meeting(fleet);
  }
}

TEST(MissionExecutive, OnlyTheLastRobotIsLeftAndDrivesEverything) {
  VirtualFleet fleet(executive_plan(3), kLoss, 3);
  fleet.run(kLimit, [&] {
    if (fleet.now == 60.0) fleet.kill(0);
    if (fleet.now == 130.0) fleet.kill(1);
  });
  expect_all_driven(fleet);
  EXPECT_EQ(fleet.robots[2].state, MissionState::kDone);
}

TEST(MissionExecutive, ALateRobotGetsWork) {
  for (const std::size_t late : {0u, 2u}) {
    VirtualFleet fleet(executive_plan(3), kLoss, 11);
    fleet.kill(late);
    fleet.run(kLimit, [&] {
      if (fleet.now == 150.0) fleet.start(late);
    });
    expect_all_driven(fleet);
    expect_at_the_meeting(fleet);
    EXPECT_GT(fleet.robots[late].driven, 200.0) << late;  // it did not only drive to the meeting
  }
}

TEST(MissionExecutive, ARestartedRobotGoesOnWithWhatTheOthersKnow) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    VirtualFleet fleet(executive_plan(3), kLoss, seed);
    double undisturbed = 0.0;
    {
      VirtualFleet other(executive_plan(3), kLoss, seed);
      undisturbed = other.run(kLimit);
    }
    const double time = fleet.run(kLimit, [&] {
      if (fleet.now == 200.0) fleet.kill(1);
      if (fleet.now == 220.0) fleet.start(1);
    });
    expect_all_driven(fleet);
    expect_at_the_meeting(fleet);
    EXPECT_LT(time, undisturbed + 250.0) << seed;  // it did not begin anew
  }
}

TEST(MissionExecutive, ARobotThatIsOnlyOutOfReachAgreesAgain) {
  VirtualFleet fleet(executive_plan(3), kLoss, 5);
  fleet.silent = [](std::size_t k, double now) { return k == 1 && now > 60.0 && now < 240.0; };
  fleet.run(kLimit);
  expect_all_driven(fleet);
  expect_at_the_meeting(fleet);
}

TEST(MissionExecutive, AFleetThatHearsNothingAtAllStillDrivesEverything) {
  VirtualFleet fleet(executive_plan(2), 1.0, 5);
  fleet.run(3.0 * kLimit);
  expect_all_driven(fleet);
}

TEST(MissionExecutive, ABlockedRowIsTriedFromBothEndsAndEndsTheMission) {
  VirtualFleet fleet(executive_plan(3), kLoss, 2);
  const Row& row = fleet.plan->mission.rows[4];
  fleet.obstacles.push_back({0.5 * (row.waypoints.front() + row.waypoints.back()), 3.0});
  fleet.run(kLimit);
  EXPECT_GE(fleet.rows_driven() + 1, fleet.plan->mission.rows.size());
  expect_at_the_meeting(fleet);
}

TEST(MissionExecutive, ARowThatNobodyCanEnterIsAbandoned) {
  VirtualFleet fleet(executive_plan(3), kLoss, 2);
  const Row& row = fleet.plan->mission.rows[4];
  fleet.obstacles.push_back({row.waypoints.front(), 3.0});
  fleet.obstacles.push_back({row.waypoints.back(), 3.0});
  fleet.run(kLimit);
  EXPECT_GE(fleet.rows_driven() + 1, fleet.plan->mission.rows.size());
  expect_at_the_meeting(fleet);
  ASSERT_EQ(fleet.robots[0].executive->status().abandoned.size(), 1u);
  EXPECT_EQ(fleet.robots[0].executive->status().abandoned[0].row, row.id);
}

TEST(MissionExecutive, TheReasonForAnAbandonedRowIsTold) {
  VirtualFleet fleet(executive_plan(3), kLoss, 2);
  const Row& row = fleet.plan->mission.rows[4];
  const Eigen::Vector2d middle = 0.5 * (row.waypoints.front() + row.waypoints.back());
  fleet.obstacles.push_back({middle, 20.0});
  fleet.run(kLimit);
  expect_at_the_meeting(fleet);
  std::size_t reasons = 0;
  for (const auto& robot : fleet.robots) {
    for (const auto& abandoned : robot.executive->status().abandoned) {
      if (abandoned.row != row.id || abandoned.why.empty()) continue;
      ++reasons;
      EXPECT_NE(abandoned.why.find("blocked near ("), std::string::npos) << abandoned.why;
    }
  }
  EXPECT_EQ(reasons, 2u) << "a second robot tries it, a third does not";
}

TEST(MissionExecutive, ARowWithAThingAcrossItIsDrivenOnceBothSidesAreSeen) {
  testing::SiteSpec spec;
  spec.width = spec.depth = 45.0;  // of which the thing hides more than a tenth
  const auto plan = plan_fleet(testing::site(spec), testing::fleet(3, false), {});
  ASSERT_TRUE(plan) << plan.error().message;
  VirtualFleet fleet(*plan, kLoss, 2);
  const Row& row = fleet.plan->mission.rows[4];
  fleet.obstacles.push_back({0.5 * (row.waypoints.front() + row.waypoints.back()), 3.0});
  fleet.run(kLimit);
  for (const auto& robot : fleet.robots) {
    for (const auto& abandoned : robot.executive->status().abandoned)
      ADD_FAILURE() << abandoned.row << ": " << abandoned.why;
  }
}

TEST(MissionExecutive, AFleetThatIsStuckAltogetherEnds) {
  VirtualFleet fleet(executive_plan(2), kLoss, 2);
  const double time = fleet.run(kLimit, [&] {
    for (auto& robot : fleet.robots) {
      if (fleet.now >= 100.0) robot.speed = 0.0;
    }
  });
  EXPECT_LT(time, 1500.0);
  for (const auto& robot : fleet.robots) {
    EXPECT_EQ(robot.state, MissionState::kDone);
    const auto status = robot.executive->status();
    EXPECT_EQ(status.done + status.abandoned.size(), status.rows);
    EXPECT_GT(status.abandoned.size(), 0u);
  }
}

TEST(MissionExecutive, WhereverARobotReallyBeginsItDrivesItsShare) {
  auto plan = executive_plan(3);
  VirtualFleet fleet(plan, kLoss, 6);
  fleet.robots[0].pose.position += Eigen::Vector2d(-3.0, 6.0);
  fleet.robots[1].pose.position += Eigen::Vector2d(-7.0, -4.0);
  fleet.robots[2].pose.position += Eigen::Vector2d(2.0, 40.0);  // as if it had been restarted
  fleet.run(kLimit);
  expect_all_driven(fleet);
  expect_at_the_meeting(fleet);
}

TEST(MissionExecutive, AStuckRobotGivesItsRowsAway) {
  VirtualFleet fleet(executive_plan(3), kLoss, 2);
  fleet.run(kLimit, [&] {
    if (fleet.now == 100.0) fleet.obstacles.push_back({fleet.robots[1].pose.position, 1e-3});
    if (fleet.now >= 100.0) fleet.robots[1].speed = 0.0;
  });
  expect_all_driven(fleet);
  EXPECT_EQ(fleet.robots[0].state, MissionState::kDone);
  EXPECT_EQ(fleet.robots[2].state, MissionState::kDone);
  EXPECT_TRUE(fleet.robots[1].state == MissionState::kStuck || fleet.robots[1].state == MissionState::kDone);
}

TEST(MissionExecutive, ARobotLowOnBatteryDrivesHome) {
  VirtualFleet fleet(executive_plan(3), kLoss, 9);
  fleet.robots[2].drain = 1.0 / 300.0;
  fleet.run(kLimit);
  expect_all_driven(fleet);
  EXPECT_LT((fleet.robots[2].pose.position - fleet.plan->fleet[2].start.position).norm(), 3.0);
  EXPECT_EQ(fleet.robots[0].state, MissionState::kDone);
}

TEST(MissionExecutive, TheSameInputGivesTheSameMission) {
  const auto once = [] {
    VirtualFleet fleet(executive_plan(3), kLoss, 4);
    fleet.run(400.0, [&] {
      if (fleet.now == 90.0) fleet.kill(0);
    });
    std::vector<double> trace;
    for (const auto& robot : fleet.robots) {
      trace.push_back(robot.pose.position.x());
      trace.push_back(robot.pose.position.y());
      trace.push_back(robot.driven);
    }
    return trace;
  };
  EXPECT_EQ(once(), once());
}

TEST(MissionExecutive, ReportsAreSmallAndBrokenOnesAreIgnored) {
  const auto plan = executive_plan(2);
  auto executive = *MissionExecutive::create(plan, testing::name(0));
  executive.update({stamp_from_ns(1), plan->fleet[0].start});
  const MissionReport own = executive.report();
  EXPECT_EQ(own.claimed.bytes().size(), (plan->mission.rows.size() + 7) / 8);
  EXPECT_EQ(RowSet(200).bytes().size(), 25u);

  MissionReport odd;
  odd.from = *AgentId::parse("stranger");
  odd.done = RowSet(plan->mission.rows.size());
  odd.done.set(0);
  executive.on_report(odd, stamp_from_ns(2));
  odd.from = testing::name(1);
  odd.position = {std::nan(""), 0.0};
  executive.on_report(odd, stamp_from_ns(2));
  EXPECT_EQ(executive.status().done, 0u);
  odd.position = {0.0, 0.0};
  odd.done = RowSet(8000, std::vector<std::uint8_t>(1000, 0xff));  // of another mission: longer than ours
  odd.claimed = RowSet(3);
  odd.current = 4'000'000'000u;
  executive.on_report(odd, stamp_from_ns(3));
  executive.update({stamp_from_ns(4), plan->fleet[0].start});
  EXPECT_EQ(executive.status().done, plan->division.routes[1].visits.size())
      << "of rows it does not own: hearsay";
  EXPECT_FALSE(MissionExecutive::create(plan, *AgentId::parse("nobody")));
}

/// Says that all rows are driven, in the name of the second robot.
MissionReport forged_report(const FleetPlan& plan, Stamp now) {
  MissionReport report;
  report.from = plan.fleet[1].id;
  report.stamp = now;
  report.position = plan.fleet[1].start.position;
  const std::size_t rows = plan.mission.rows.size();
  report.done = RowSet(rows, std::vector<std::uint8_t>((rows + 7) / 8, 0xff));
  return report;
}

TEST(MissionExecutive, ForgedReportsMakeNobodySkipARow) {
  for (const bool claims : {false, true}) {
    VirtualFleet fleet(executive_plan(3), kLoss, 4);
    fleet.run(kLimit, [&] {
      if (static_cast<int>(fleet.now) % 60 != 30 || fleet.now > 400.0) return;
      MissionReport forged = forged_report(*fleet.plan, fleet.stamp());
      if (claims) forged.claimed = forged.done;
      for (const std::size_t victim : {0u, 2u})
        fleet.robots[victim].executive->on_report(forged, fleet.stamp());
    });
    expect_all_driven(fleet);
    expect_at_the_meeting(fleet);
  }
}

TEST(MissionExecutive, HearsayCountsForRowsWithNodesAlongThem) {
  const auto plan = executive_plan(3);
  auto executive = *MissionExecutive::create(plan, testing::name(0));
  MissionInput input{stamp_from_ns(1), plan->fleet[0].start};
  executive.update(input);
  executive.on_report(forged_report(*plan, stamp_from_ns(2)), stamp_from_ns(2));
  const std::size_t own = plan->division.routes[1].visits.size();
  EXPECT_EQ(executive.status().done, own);
  input.now = stamp_from_ns(3);
  input.surveyed = RowSet(plan->mission.rows.size());
  for (const RowVisit& visit : plan->division.routes[2].visits) {
    const auto row = std::ranges::find(plan->mission.rows, visit.row, &Row::id);
    input.surveyed.set(static_cast<std::size_t>(row - plan->mission.rows.begin()));
  }
  executive.update(input);
  EXPECT_EQ(executive.status().done, own + plan->division.routes[2].visits.size());
  // The next report of the second robot tells what it really drove.
  MissionReport genuine = forged_report(*plan, stamp_from_ns(4));
  genuine.done = {};
  executive.on_report(genuine, stamp_from_ns(4));
  EXPECT_EQ(executive.status().done, plan->division.routes[2].visits.size());
}

TEST(MissionExecutive, KeepsTheLastReportOfEachOtherRobot) {
  const auto plan = executive_plan(3);
  auto executive = *MissionExecutive::create(plan, testing::name(0));
  executive.update({stamp_from_ns(1), plan->fleet[0].start});
  EXPECT_TRUE(executive.heard_reports().empty());
  MissionReport report = forged_report(*plan, stamp_from_ns(2));
  executive.on_report(report, stamp_from_ns(2));
  report.stamp = stamp_from_ns(3);
  report.state = MissionState::kMeeting;
  executive.on_report(report, stamp_from_ns(3));
  const auto heard = executive.heard_reports();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].from, testing::name(1));
  EXPECT_EQ(heard[0].state, MissionState::kMeeting);
}

TEST(MissionExecutive, WithoutAPositionTheRobotStands) {
  const auto plan = executive_plan(2);
  auto executive = *MissionExecutive::create(plan, testing::name(0));
  const MissionAction action = executive.update({stamp_from_ns(1), {{std::nan(""), 0.0}, 0.0}});
  EXPECT_EQ(action.kind, MissionAction::Kind::kHold);
}

}  // namespace
}  // namespace fleetmap::planning
