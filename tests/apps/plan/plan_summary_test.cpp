#include "plan/plan_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "robot/mission_setup.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class PlanSummary : public ::testing::Test {
 protected:
  PlanSummary() {
    sim::SiteDrawing drawing;
    for (const double y : {0.0, 4.0}) drawing.lanes.push_back({{-20.0, y}, {20.0, y}});
    drawing.boundary = {{-30.0, -20.0}, {30.0, -20.0}, {30.0, 20.0}, {-30.0, 20.0}};
    site_.mission = mission_on(drawing);
    planning::RobotAbility robot;
    robot.id = AgentId::parse("r1").value();
    plan_ = std::make_unique<planning::FleetPlan>(*plan_on(site_.mission, {robot}, {}).value());
  }
  std::string printed() const {
    std::ostringstream out;
    print_plan(out, *plan_, site_);
    return out.str();
  }

  DrawnSite site_;
  std::unique_ptr<planning::FleetPlan> plan_;
};

TEST_F(PlanSummary, NamesTheRowsOfEachRobotInTheirOrderAndDirection) {
  planning::RobotRoute& route = plan_->division.routes[0];
  route.length = 123.4;
  route.time = 90.0;
  route.visits = {{1, true}, {0, false}};
  EXPECT_THAT(printed(), HasSubstr("r1: 2 rows, 123 m, 90 s: 1 (from its end) 0\n"));
}

TEST_F(PlanSummary, SaysWhenAllIsDoneAndWhichRowsNoBatteryReaches) {
  plan_->meeting.reset();
  plan_->completion = 240.0;
  EXPECT_THAT(printed(), HasSubstr("all rows are driven after 240 s\n"));
  EXPECT_THAT(printed(), Not(HasSubstr("left out")));
  plan_->division.left_out = {1};
  EXPECT_THAT(printed(), HasSubstr("left out, since no battery reaches them: 1\n"));
  plan_->meeting.emplace();
  plan_->meeting->latest = 200.0;
  EXPECT_THAT(printed(), HasSubstr(" after 200 s; all maps are exchanged after 240 s\n"));
}

}  // namespace
}  // namespace fleetmap::apps
