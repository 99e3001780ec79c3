// Whole missions in which an operator gives rows away and calls robots home.
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/mission/virtual_fleet.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::kLimit;
using testing::kLoss;
using testing::VirtualFleet;

class OperatorOrders : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  OperatorOrders() {
    testing::SiteSpec spec;
    spec.width = spec.depth = 120.0;
    spec.missing = 0.1;
    MissionConfig config;
    config.division.search_rounds = 30;
    plan_ = *plan_fleet(testing::site(spec), testing::fleet(3, false), config);
    fleet_.emplace(plan_, kLoss, GetParam());
  }
  /// Calls `act` once, at the first second from `time` on at which robot 0 is on a row and has others left.
  void run(double time, const std::function<void()>& act) {
    bool acted = false;
    fleet_->run(kLimit, [&] {
      if (acted || fleet_->now < time || report(0).current == MissionReport::kNoRow) return;
      if (report(0).claimed.count() < 2) return;
      acted = true;
      act();
    });
    EXPECT_TRUE(acted);
  }
  MissionReport report(std::size_t k) const { return fleet_->robots[k].executive->report(); }
  RowId under_way() const { return plan_->mission.rows[report(0).current].id; }
  /// A row that robot 0 has claimed and has not begun.
  RowId waiting() const {
    const MissionReport now = report(0);
    std::size_t row = 0;
    while (!now.claimed.has(row) || row == now.current) ++row;
    return plan_->mission.rows[row].id;
  }
  double length(RowId row) const {
    return length_of(std::ranges::find(plan_->mission.rows, row, &Row::id)->waypoints);
  }
  void expect_all_driven() const { EXPECT_EQ(fleet_->rows_driven(), plan_->mission.rows.size()); }
  void expect_drove(std::size_t k, RowId row) const {
    EXPECT_GT(fleet_->driven_by(k, row), 0.95 * length(row)) << k;
  }
  /// Crossing a row is not driving it.
  void expect_did_not_drive(std::size_t k, RowId row) const {
    EXPECT_LT(fleet_->driven_by(k, row), 0.1 * length(row)) << k;
  }
  void expect_home(std::size_t k) const {
    EXPECT_LT((fleet_->robots[k].pose.position - plan_->fleet[k].start.position).norm(), 1.0) << k;
  }

  std::shared_ptr<const FleetPlan> plan_;
  std::optional<VirtualFleet> fleet_;
};

TEST_P(OperatorOrders, AGivenRowIsDrivenByItsReceiverAlone) {
  RowId row = 0;
  run(30.0, [&] { fleet_->give(row = waiting(), 0, 2); });
  expect_all_driven();
  expect_drove(2, row);
  expect_did_not_drive(0, row);
  expect_did_not_drive(1, row);
}

TEST_P(OperatorOrders, ARowUnderWayIsLeftToItsReceiver) {
  RowId row = 0;
  run(30.0, [&] { fleet_->give(row = under_way(), 0, 1); });
  expect_all_driven();
  expect_drove(1, row);
  expect_did_not_drive(2, row);
}

TEST_P(OperatorOrders, ARowThatIsTakenFromARobotGoesToExactlyOneOther) {
  RowId row = 0;
  run(30.0, [&] { fleet_->give(row = waiting(), 0, std::nullopt); });
  expect_all_driven();
  expect_did_not_drive(0, row);
  EXPECT_LT(std::min(fleet_->driven_by(1, row), fleet_->driven_by(2, row)), 0.1 * length(row));
}

TEST_P(OperatorOrders, TheRowOfAReceiverThatFailsIsNotLost) {
  for (const bool before : {true, false}) {
    fleet_.emplace(plan_, kLoss, GetParam());
    RowId row = 0;
    run(30.0, [&] {
      if (before) fleet_->kill(2);
      fleet_->give(row = waiting(), 0, 2);
    });
    if (before) expect_all_driven();
    fleet_.emplace(plan_, kLoss, GetParam());
    double ordered_at = kLimit;
    fleet_->run(kLimit, [&] {
      if (ordered_at == kLimit && fleet_->now >= 30.0 && report(0).claimed.count() > 1) {
        fleet_->give(row = waiting(), 0, 2);
        ordered_at = fleet_->now;
      }
      if (fleet_->now == ordered_at + 25.0) fleet_->kill(2);
    });
    expect_all_driven();
  }
}

TEST_P(OperatorOrders, TheGiverKeepsARowWhoseReceiverDoesNotHearOfIt) {
  RowId row = 0;
  run(30.0, [&] {
    row = waiting();
    const messages::RowOrder order{fleet_->stamp(), plan_->fleet[0].id, plan_->fleet[2].id, {}, row};
    for (const std::size_t k : {0u, 1u}) fleet_->robots[k].executive->set_row_orders({order});
  });
  expect_all_driven();
  expect_drove(0, row);
}

TEST_P(OperatorOrders, ARobotThatIsCalledHomeDrivesThereAndTheOthersDriveItsRows) {
  double before = 0.0, way = 0.0;
  run(60.0, [&] {
    fleet_->robots[0].called_home = true;
    way = (fleet_->robots[0].pose.position - plan_->fleet[0].start.position).norm();
    before = fleet_->robots[0].driven;
  });
  expect_all_driven();
  expect_home(0);
  EXPECT_LT(fleet_->robots[0].driven - before, 2.0 * way + 60.0) << "on its way it drives nothing else";
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_EQ(fleet_->robots[k].state, MissionState::kDone);
    EXPECT_LT((fleet_->robots[k].pose.position - plan_->meeting->place).norm(), 45.0);
  }
}

TEST_P(OperatorOrders, ResumeUndoesTheCall) {
  fleet_->run(kLimit, [&] {
    if (fleet_->now == 60.0) fleet_->robots[0].called_home = true;
    if (fleet_->now == 90.0) fleet_->robots[0].called_home = false;
  });
  expect_all_driven();
  for (const VirtualFleet::Robot& robot : fleet_->robots) {
    EXPECT_EQ(robot.state, MissionState::kDone);
    EXPECT_LT((robot.pose.position - plan_->meeting->place).norm(), 45.0);
  }
}

TEST_P(OperatorOrders, TheCallOutlivesARestart) {
  fleet_->run(kLimit, [&] {
    if (fleet_->now == 60.0) fleet_->robots[0].called_home = true;
    if (fleet_->now == 64.0) fleet_->kill(0);
    if (fleet_->now == 70.0) fleet_->start(0);
  });
  expect_all_driven();
  expect_home(0);
}

TEST_P(OperatorOrders, AFleetThatIsCalledHomeAltogetherEndsThere) {
  const double time = fleet_->run(kLimit, [&] {
    for (auto& robot : fleet_->robots) robot.called_home = fleet_->now >= 60.0;
  });
  EXPECT_LT(time, 1500.0);
  EXPECT_LT(fleet_->rows_driven(), plan_->mission.rows.size());
  for (const std::size_t k : {0u, 1u, 2u}) expect_home(k);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OperatorOrders, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace fleetmap::planning
