// Positions of twins in virtual time, driven by whole agents, after the orders of an operator.
#include <gtest/gtest.h>

#include "agent/driven_fleet.hpp"

namespace fleetmap::agent {
namespace {

using namespace std::chrono_literals;
using messages::MissionState;
using testing::DrivenFleet;

class OperatorOrders : public ::testing::Test {
 protected:
  OperatorOrders() {
    for (const char* name : {"r1", "r2"}) starts_[name] = place(name);
  }
  Eigen::Vector2d place(const std::string& name) {
    return fleet_.robot(name).twin->T_enu_base().translation().head<2>();
  }
  double from_start(const std::string& name) { return (place(name) - starts_.at(name)).norm(); }
  planning::MissionExecutive::Status status(const std::string& name) {
    return fleet_.robot(name).agent->navigator()->status();
  }
  /// The largest distance from the start within `time`.
  double farthest(const std::string& name, Duration time) {
    double farthest = 0.0;
    for (const Stamp end = fleet_.now() + time; fleet_.now() < end; fleet_.run_for(500ms))
      farthest = std::max(farthest, from_start(name));
    return farthest;
  }
  bool run_until(Duration limit, const std::function<bool()>& condition) {
    for (const Stamp end = fleet_.now() + limit; fleet_.now() < end && !condition();) fleet_.run_for(1s);
    return condition();
  }

  DrivenFleet fleet_{{.robots = {"r1", "r2"}}};
  std::map<std::string, Eigen::Vector2d> starts_;
};

TEST_F(OperatorOrders, AHeldRobotStaysWhereItIs) {
  ASSERT_TRUE(fleet_.run_until_driving());
  const Eigen::Vector2d ordered = place("r1");
  fleet_.order("r1", true);
  fleet_.run_for(4s);
  const Eigen::Vector2d held = place("r1"), other = place("r2");
  EXPECT_LT((held - ordered).norm(), 1.5) << "it stops within a second from its 1.5 m/s";
  fleet_.run_for(20s);
  EXPECT_LT((place("r1") - held).norm(), 0.02);
  EXPECT_GT((place("r2") - other).norm(), 2.0) << "the other one drives on";
}

TEST_F(OperatorOrders, ARobotCalledHomeEndsAtItsStartAndTheOtherDrivesItsRow) {
  ASSERT_TRUE(fleet_.run_until_driving());
  const double way = farthest("r1", 3s);
  ASSERT_GT(way, 2.0);
  fleet_.call_home("r1");
  ASSERT_TRUE(run_until(60s, [&] { return status("r1").state == MissionState::kCalledHome; }));
  EXPECT_EQ(status("r1").mine, 0u);
  EXPECT_TRUE(run_until(300s, [&] { return status("r2").done == 2; })) << status("r2").done;
  EXPECT_TRUE(run_until(60s, [&] { return from_start("r1") < 3.0; })) << from_start("r1");
  fleet_.restart("r1");
  EXPECT_LT(farthest("r1", 20s), 4.0) << "it stays there, also when its program starts anew";
  EXPECT_EQ(status("r1").mine, 0u);
}

TEST_F(OperatorOrders, ResumeUndoesTheCall) {
  ASSERT_TRUE(fleet_.run_until_driving());
  fleet_.call_home("r1");
  ASSERT_TRUE(run_until(60s, [&] { return status("r1").state == MissionState::kCalledHome; }));
  fleet_.order("r1", false);
  EXPECT_TRUE(run_until(300s, [&] { return status("r1").done == 2 && status("r2").done == 2; }));
  EXPECT_NE(status("r1").state, MissionState::kCalledHome);
}

TEST_F(OperatorOrders, ARobotThatIsHeldOnItsWayHomeGoesOnHomeAfterResume) {
  ASSERT_TRUE(fleet_.run_until_driving());
  ASSERT_GT(farthest("r1", 20s), 10.0);
  fleet_.call_home("r1");
  ASSERT_TRUE(run_until(60s, [&] { return status("r1").state == MissionState::kCalledHome; }));
  fleet_.order("r1", true);
  fleet_.run_for(4s);
  const Eigen::Vector2d held = place("r1");
  ASSERT_GT(from_start("r1"), 5.0) << "it is under way";
  fleet_.run_for(10s);
  EXPECT_LT((place("r1") - held).norm(), 0.02);
  fleet_.order("r1", false);
  EXPECT_TRUE(run_until(120s, [&] { return from_start("r1") < 3.0; })) << from_start("r1");
  EXPECT_EQ(status("r1").state, MissionState::kCalledHome);
  EXPECT_EQ(status("r1").mine, 0u);
}

TEST_F(OperatorOrders, AGivenRowIsDrivenByItsReceiver) {
  ASSERT_TRUE(fleet_.run_until_driving());
  const auto& row = fleet_.robot("r2").agent->navigator()->executive().plan().mission.rows.at(1);
  const Eigen::Vector2d middle = 0.5 * (row.waypoints.front() + row.waypoints.back());
  fleet_.give("r2", row.id, "r1");
  ASSERT_TRUE(run_until(30s, [&] { return status("r1").mine == 2 && status("r2").mine == 0; }));
  double nearest = 1e3;
  EXPECT_TRUE(run_until(300s, [&] {
    nearest = std::min(nearest, (place("r1") - middle).norm());
    return status("r1").done == 2;
  }));
  EXPECT_LT(nearest, 2.0) << "r1 drove through the row of r2";
}

}  // namespace
}  // namespace fleetmap::agent
