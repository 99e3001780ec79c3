#include "robot/mission_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Three lanes of 40 m to the east, 4 m apart, on ground of 60 m x 40 m.
sim::SiteDrawing three_lanes() {
  sim::SiteDrawing drawing;
  for (const double y : {0.0, 4.0, 8.0}) drawing.lanes.push_back({{-20.0, y}, {20.0, y}});
  drawing.boundary = {{-30.0, -20.0}, {30.0, -20.0}, {30.0, 20.0}, {-30.0, 20.0}};
  return drawing;
}

planning::RobotAbility robot(const char* name) {
  planning::RobotAbility ability;
  ability.id = AgentId::parse(name).value();
  return ability;
}

TEST(MissionSetup, EachLaneOfADrawingIsARowAndTheFirstOnesBeginIsTheStart) {
  const planning::Mission mission = mission_on(three_lanes());
  ASSERT_EQ(mission.rows.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(mission.rows[k].id, k);
    EXPECT_EQ(mission.rows[k].waypoints.front(), Eigen::Vector2d(-20.0, 4.0 * static_cast<double>(k)));
    EXPECT_EQ(mission.rows[k].waypoints.back(), Eigen::Vector2d(20.0, 4.0 * static_cast<double>(k)));
  }
  EXPECT_EQ(mission.start_of(robot("r1").id), Eigen::Vector2d(-20.0, 0.0));
  EXPECT_TRUE(mission_on({}).starts.empty());
}

TEST(MissionSetup, RobotsStartWhereTheDrawingSaysAndLookAlongTheFirstRow) {
  sim::SiteDrawing north = three_lanes();
  for (sim::Aisle& lane : north.lanes) {
    std::swap(lane.from.x(), lane.from.y());
    std::swap(lane.to.x(), lane.to.y());
  }
  north.boundary = {{-20.0, -30.0}, {20.0, -30.0}, {20.0, 30.0}, {-20.0, 30.0}};
  const auto plan = plan_on(mission_on(north), {robot("r1"), robot("r2")}, {});
  ASSERT_TRUE(plan) << plan.error().message;
  for (const planning::RobotAbility& one : (*plan)->fleet) {
    EXPECT_LT((one.start.position - Eigen::Vector2d(0.0, -20.0)).norm(), 1e-9);
    EXPECT_NEAR(one.start.yaw, 0.5 * std::numbers::pi, 1e-9);
  }
}

TEST(MissionSetup, OnlySelectedRowsAreDivided) {
  planning::MissionConfig settings;
  settings.rows.every = 2;
  const auto plan = plan_on(mission_on(three_lanes()), {robot("r1")}, settings);
  ASSERT_TRUE(plan) << plan.error().message;
  std::vector<planning::RowId> driven;
  for (const planning::RowVisit& visit : (*plan)->division.routes[0].visits) driven.push_back(visit.row);
  std::ranges::sort(driven);
  EXPECT_THAT(driven, ElementsAre(0u, 2u));
}

TEST(MissionSetup, ADrawingWithoutRowsIsRefused) {
  const auto plan = plan_on(planning::Mission{}, {robot("r1")}, {});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("row"));
}

}  // namespace
}  // namespace fleetmap::apps
