#include "mission/executive_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planning/mission/small_plan.hpp"

namespace fleetmap::planning {
namespace {

using testing::at;
using testing::plan_for;

class ExecutiveStateTest : public ::testing::Test {
 protected:
  MissionInput input(double time) const {
    MissionInput input;
    input.now = at(time);
    input.pose = plan_->fleet[0].start;
    input.path_number = state_.path_number;
    return input;
  }
  /// Begins and sets out to the first row.
  void set_out() {
    state_.begin(input(0.0));
    state_.select_goal(input(0.0));
    ASSERT_EQ(state_.goal, Goal::kRow);
  }

  std::shared_ptr<const FleetPlan> plan_ = plan_for(2);
  ExecutiveState state_{plan_, 0};
};

TEST_F(ExecutiveStateTest, ARobotFarFromItsStartListensFirst) {
  state_.begin(input(5.0));
  EXPECT_EQ(state_.listen_until, at(5.0));
  ExecutiveState restarted(plan_, 0);
  MissionInput elsewhere = input(5.0);
  elsewhere.pose.position += Eigen::Vector2d(40.0, 0.0);
  restarted.begin(elsewhere);
  EXPECT_EQ(restarted.listen_until, at(5.0 + plan_->config.executive.listen));
}

TEST_F(ExecutiveStateTest, ADrivenRowIsDoneAndTheNextOneFollows) {
  set_out();
  const std::size_t row = state_.claims.current().value();
  const std::uint64_t path = state_.path_number;
  MissionInput finished = input(60.0);
  finished.finished = true;
  state_.follow_up(finished);
  EXPECT_TRUE(state_.board.done().has(row));
  EXPECT_FALSE(state_.claims.current());
  EXPECT_EQ(state_.goal, Goal::kNone);
  state_.select_goal(input(60.0));
  EXPECT_EQ(state_.goal, Goal::kRow);
  EXPECT_NE(state_.claims.current().value(), row);
  EXPECT_EQ(state_.path_number, path + 1);
}

TEST_F(ExecutiveStateTest, ProgressOnAnOlderPathIsIgnored) {
  set_out();
  const std::size_t row = state_.claims.current().value();
  MissionInput old = input(1.0);
  old.path_number = state_.path_number - 1;
  old.finished = true;
  state_.follow_up(old);
  EXPECT_EQ(state_.claims.current(), row);
  EXPECT_FALSE(state_.board.done().has(row));
}

TEST_F(ExecutiveStateTest, AStuckRobotGivesItsRowsBackUntilItCanMove) {
  set_out();
  const int limit = plan_->config.executive.stuck_limit;
  for (int k = 0; k < limit; ++k) {
    EXPECT_EQ(state_.state, MissionState::kDriving) << k;
    MissionInput stuck = input(100.0 + 40.0 * k);
    stuck.stuck = true;
    state_.follow_up(stuck);
    state_.select_goal(input(100.0 + 40.0 * k));
  }
  EXPECT_EQ(state_.state, MissionState::kStuck);
  EXPECT_TRUE(state_.claims.all().empty());
  // Later it sets out for the meeting, and gets on.
  state_.select_goal(input(1000.0));
  EXPECT_EQ(state_.goal, Goal::kMeeting);
  MissionInput moved = input(1010.0);
  moved.pose.position += Eigen::Vector2d(5.0, 0.0);
  state_.follow_up(moved);
  EXPECT_EQ(state_.state, MissionState::kDriving);
  EXPECT_TRUE(state_.attempts.abandoned().none());
}

TEST_F(ExecutiveStateTest, ALowBatteryBringsItHome) {
  set_out();
  MissionInput low = input(10.0);
  low.battery = plan_->config.executive.low_battery;
  low.pose.position += Eigen::Vector2d(10.0, 0.0);
  state_.check_battery(low);
  EXPECT_EQ(state_.state, MissionState::kLowBattery);
  EXPECT_TRUE(state_.claims.all().empty());
  state_.select_goal(low);
  EXPECT_EQ(state_.goal, Goal::kHome);
  EXPECT_LT((state_.path.back() - plan_->fleet[0].start.position).norm(), 1e-6);
  // Charged a little is not enough, charged well is.
  low.battery += 0.1;
  state_.check_battery(low);
  EXPECT_EQ(state_.state, MissionState::kLowBattery);
  low.battery += 0.2;
  state_.check_battery(low);
  EXPECT_EQ(state_.state, MissionState::kDriving);
}

TEST_F(ExecutiveStateTest, ACallBringsItHomeUntilItIsLetGo) {
  set_out();
  MissionInput called = input(10.0);
  called.called_home = true;
  called.pose.position += Eigen::Vector2d(10.0, 0.0);
  state_.check_call(called);
  EXPECT_EQ(state_.state, MissionState::kCalledHome);
  EXPECT_TRUE(state_.claims.all().empty());
  state_.select_goal(called);
  EXPECT_EQ(state_.goal, Goal::kHome);
  EXPECT_LT((state_.path.back() - plan_->fleet[0].start.position).norm(), 1e-6);
  // An empty battery on the way changes the reason alone.
  called.battery = plan_->config.executive.low_battery;
  state_.check_battery(called);
  EXPECT_EQ(state_.state, MissionState::kLowBattery);
  called.battery = 1.0;
  state_.check_battery(called);
  EXPECT_EQ(state_.state, MissionState::kCalledHome);
  called.called_home = false;
  state_.check_call(called);
  EXPECT_EQ(state_.state, MissionState::kDriving);
  EXPECT_EQ(state_.goal, Goal::kNone);
}

TEST_F(ExecutiveStateTest, TheReportHoldsWhatItClaims) {
  set_out();
  state_.update_report(input(3.0));
  EXPECT_EQ(state_.report.from, plan_->fleet[0].id);
  EXPECT_EQ(state_.report.stamp, at(3.0));
  EXPECT_EQ(state_.report.current, *state_.claims.current());
  EXPECT_EQ(state_.report.claimed.count(), plan_->division.routes[0].visits.size());
}

}  // namespace
}  // namespace fleetmap::planning
