#include "monitor/foxglove/fleet_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/monitor/fleet_drawing.hpp"
#include "monitor/foxglove/read_scene.hpp"
#include "monitor/views.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using graph::AlignmentStatus;
using ::testing::ElementsAre;
using ::testing::Field;
using testing::node_id;
using testing::read_scene;
using testing::ReadEntity;
using testing::ViewMaker;

using Points = std::vector<std::vector<double>>;

TEST(FleetScene, a_robots_trajectory_has_a_line_a_session_and_a_sphere_a_node) {
  ViewMaker fleet;
  fleet.robot("r1", 0.0, 3).robot("r2", 50.0, 2);
  graph::Node& later = fleet.view.nodes[2];
  fleet.view.placement.T_enu_node.erase(later.id);
  later.id.seq = first_seq(7);
  later.session = 7;
  fleet.view.placement.T_enu_node[later.id] = Pose(Eigen::Translation3d(0.0, 9.0, 0.0));
  std::swap(fleet.view.nodes[0], fleet.view.nodes[1]);
  const auto read = read_scene(trajectories_message(fleet.view));
  ASSERT_THAT(read, ElementsAre(Field(&ReadEntity::id, "r1"), Field(&ReadEntity::id, "r2")));
  ASSERT_EQ(read[0].lines.size(), 2u);
  EXPECT_EQ(read[0].lines[0].points, (Points{{0, 0, 0}, {4, 0, 0}})) << "in the order of the nodes";
  EXPECT_EQ(read[0].lines[1].points, (Points{{0, 9, 0}}));
  EXPECT_EQ(read[0].spheres.size(), 3u);
  ASSERT_EQ(read[1].lines.size(), 1u);
  EXPECT_EQ(read[1].lines[0].points, (Points{{50, 0, 0}, {54, 0, 0}}));
  EXPECT_NE(read[0].lines[0].color, read[1].lines[0].color);
}

TEST(FleetScene, alignments_are_coloured_by_status) {
  ViewMaker fleet;
  fleet.robot("r1", 0.0).robot("r2", 50.0);
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), AlignmentStatus::used)
      .alignment(node_id("r1", 1), node_id("r2", 1), AlignmentStatus::against_gps)
      .alignment(node_id("r1", 2), node_id("r2", 2), AlignmentStatus::used)
      .alignment(node_id("r1", 9), node_id("r2", 2), AlignmentStatus::waiting);
  std::map<std::string, ReadEntity> read;
  for (const ReadEntity& entity : read_scene(alignments_message(fleet.view))) read[entity.id] = entity;
  EXPECT_EQ(read.size(), 7u) << "also those without any, so that a client drops what it drew before";
  const ReadEntity& used = read[graph::to_string(AlignmentStatus::used)];
  ASSERT_EQ(used.lines.size(), 1u);
  EXPECT_EQ(used.lines[0].type, 2u) << "a line of its own for each two points";
  EXPECT_EQ(used.lines[0].points, (Points{{0, 0, 0}, {50, 0, 0}, {8, 0, 0}, {58, 0, 0}}));
  const ReadEntity& against = read[graph::to_string(AlignmentStatus::against_gps)];
  ASSERT_EQ(against.lines.size(), 1u);
  EXPECT_NE(against.lines[0].color, used.lines[0].color);
  EXPECT_TRUE(read[graph::to_string(AlignmentStatus::waiting)].lines.empty())
      << "one of its nodes has no place";
}

TEST(FleetScene, an_empty_fleet_is_an_empty_scene) {
  EXPECT_TRUE(read_scene(trajectories_message({})).empty());
  EXPECT_EQ(newest_stamp({}), Stamp{});
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
