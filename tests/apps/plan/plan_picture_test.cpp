#include "plan/plan_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "robot/mission_setup.hpp"

namespace fleetmap::apps {
namespace {

std::ptrdiff_t pixels_of(const eval::Image& image, eval::Rgb colour) {
  return std::ranges::count(image.pixels, colour);
}

TEST(PlanPicture, EachRobotsRowsAreInItsColour) {
  sim::SiteDrawing drawing;
  for (const double y : {0.0, 8.0, 16.0, 24.0}) drawing.lanes.push_back({{-30.0, y}, {30.0, y}});
  drawing.boundary = {{-40.0, -20.0}, {40.0, -20.0}, {40.0, 40.0}, {-40.0, 40.0}};
  std::vector<planning::RobotAbility> fleet(2);
  fleet[0].id = AgentId::parse("r1").value();
  fleet[1].id = AgentId::parse("r2").value();
  const auto plan = plan_on(mission_on(drawing), fleet, {}).value();
  const auto image = picture_of(*plan);
  ASSERT_TRUE(image) << image.error().message;
  const auto first = pixels_of(*image, eval::robot_colour(0)),
             second = pixels_of(*image, eval::robot_colour(1));
  EXPECT_GT(first, 1000) << "a row is some 1000 pixels long and several wide";
  EXPECT_GT(second, 1000);
  // A lone robot has all rows.
  const auto alone = plan_on(mission_on(drawing), {fleet[0]}, {}).value();
  const auto lone_image = picture_of(*alone);
  ASSERT_TRUE(lone_image);
  EXPECT_GT(pixels_of(*lone_image, eval::robot_colour(0)), first);
  EXPECT_EQ(pixels_of(*lone_image, eval::robot_colour(1)), 0);
}

}  // namespace
}  // namespace fleetmap::apps
