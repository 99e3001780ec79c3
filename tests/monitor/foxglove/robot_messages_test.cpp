#include "monitor/foxglove/robot_messages.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "monitor/foxglove/cdr_reader.hpp"
#include "monitor/views.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using testing::CdrReader;
using testing::node_id;
using testing::ViewMaker;

constexpr double kDegrees = 180.0 / std::numbers::pi;

TEST(RobotMessages, transforms_lead_from_the_map_to_each_robot) {
  ViewMaker fleet;
  fleet.robot("r1", 0.0).robot("r2", 50.0);
  CdrReader read(transforms_message(last_nodes(fleet.view)));
  ASSERT_EQ(read.count(), 2u);
  for (const char* robot : {"r1", "r2"}) {
    read.count(), read.count();
    EXPECT_EQ(read.text(), "enu");
    EXPECT_EQ(read.text(), robot);
    const double east = std::string(robot) == "r1" ? 8.0 : 58.0;
    EXPECT_EQ(read.numbers(7), (std::vector<double>{east, 0, 0, 0, 0, 0, 1}));
  }
  EXPECT_TRUE(read.at_end());
}

TEST(RobotMessages, a_fix_is_the_place_on_earth_with_its_covariance) {
  const GeoPoint origin = geo_point_from_degrees(49.0, 8.4, 110.0);
  LastNode last;
  last.stamp = stamp_from_ns(3'000'000'004);
  last.T_enu_node = make_pose(rotation_from_rpy(0.0, 0.0, std::numbers::pi / 2.0), {100.0, 200.0, 3.0});
  Matrix6d C = Matrix6d::Identity();
  C(0, 0) = 4.0;  // along the robot, which looks north
  last.covariance = C;
  CdrReader read(fix_message(node_id("r1", 0).agent, last, origin));
  EXPECT_EQ(read.count(), 3u);
  EXPECT_EQ(read.count(), 4u);
  EXPECT_EQ(read.text(), "r1");
  const auto place = read.numbers(3);
  const Eigen::Vector3d back =
      LocalFrame(origin).to_enu({place[0] / kDegrees, place[1] / kDegrees, place[2]});
  EXPECT_NEAR((back - Eigen::Vector3d(100.0, 200.0, 3.0)).norm(), 0.0, 1e-6);
  const auto covariance = read.numbers(9);
  EXPECT_NEAR(covariance[0], 1.0, 1e-3) << "east";
  EXPECT_NEAR(covariance[4], 4.0, 1e-3) << "north";
  EXPECT_NEAR(covariance[8], 1.0, 1e-3) << "up";
  EXPECT_EQ(read.count(), 3u) << "known";
  EXPECT_TRUE(read.at_end());
}

TEST(RobotMessages, a_fix_without_covariance_is_told_so) {
  CdrReader read(fix_message(node_id("r1", 0).agent, {}, geo_point_from_degrees(49.0, 8.4, 110.0)));
  read.count(), read.count(), read.text(), read.numbers(3);
  EXPECT_EQ(read.numbers(9), std::vector<double>(9, 0.0));
  EXPECT_EQ(read.count(), 0u) << "unknown";
}

TEST(RobotMessages, a_status_has_all_that_is_known_of_a_robot) {
  RobotNow robot;
  robot.id = node_id("r2", 0).agent;
  robot.activity = "drives row 7";
  robot.problems = {"no GPS", "battery is low"};
  robot.heard = {{"long_range", 2.5}};
  robot.battery = 0.25;
  robot.nodes = 1;
  robot.alignments = 2;
  robot.submaps = 3;
  robot.backlog_bytes = std::size_t{1} << 40;
  robot.called_home = robot.driven = true;
  CdrReader read(status_message(robot));
  EXPECT_EQ(read.text(), "r2");
  EXPECT_EQ(read.text(), "drives row 7");
  ASSERT_EQ(read.count(), 2u);
  EXPECT_EQ(read.text(), "no GPS");
  EXPECT_EQ(read.text(), "battery is low");
  ASSERT_EQ(read.count(), 1u);
  EXPECT_EQ(read.text(), "long_range");
  EXPECT_EQ(read.number<double>(), 2.5);
  EXPECT_EQ(read.number<double>(), 0.25);
  EXPECT_TRUE(std::isnan(read.number<double>())) << "sigma is not known";
  EXPECT_EQ(read.count(), 1u);
  EXPECT_EQ(read.count(), 2u);
  EXPECT_EQ(read.count(), 3u);
  EXPECT_EQ(read.count(), 4'294'967'295u) << "clamped";
  EXPECT_FALSE(read.flag()) << "ordered to hold";
  EXPECT_TRUE(read.flag()) << "called home";
  EXPECT_TRUE(read.flag()) << "driven";
  EXPECT_TRUE(read.at_end());
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
