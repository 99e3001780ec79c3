#include "fleetmap/ros_output/map_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "monitor/views.hpp"

namespace fleetmap::ros_output {
namespace {

using testing::node_id;
using testing::ViewMaker;

/// A square of points 0.5 m apart, in the middle of voxels.
cloud::PointCloud square(int side) {
  cloud::PointCloud cloud;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      cloud.points.emplace_back(0.5f * static_cast<float>(x) + 0.05f, 0.5f * static_cast<float>(y) + 0.05f,
                                0.05f);
      cloud.intensities.push_back(3.0f);
    }
  }
  return cloud;
}

class MapBuilderTest : public ::testing::Test {
 protected:
  MapBuilderTest() {
    fleet_.robot("r1", 0.0, 1).robot("r2", 50.0, 1);
    map_.add(node_id("r1", 0), square(4));
    map_.add(node_id("r2", 0), square(4));
  }
  ViewMaker fleet_;
  RosOutputConfig config_;
  const std::vector<AgentId> fleet_of_three_{node_id("r2", 0).agent, node_id("r0", 0).agent,
                                             node_id("r1", 0).agent};
  MapBuilder map_{config_, fleet_of_three_};
};

TEST_F(MapBuilderTest, TheWholeHasEverySubmapAtItsPlaceAndNamesItsRobot) {
  const ros_codec::MapPoints whole = map_.whole(fleet_.view);
  ASSERT_EQ(whole.points.size(), 32u);
  EXPECT_EQ(whole.frame, "map");
  for (const auto& point : whole.points) {
    EXPECT_EQ(point.robot, point.p.x() < 25.0f ? 1 : 2) << "r0 has no node yet";
    EXPECT_EQ(point.intensity, 3.0f);
  }
  EXPECT_EQ(std::ranges::count(whole.points, 2, &ros_codec::MapPoints::Point::robot), 16);
}

TEST_F(MapBuilderTest, ASubmapIsThinnedAndStampedWithItsNode) {
  cloud::PointCloud twice = square(4);
  cloud::append(twice, square(4));
  map_.add(node_id("r1", 0), twice);
  graph::Node& node = fleet_.view.nodes[0];
  node.stamp = stamp_from_ns(77);
  const ros_codec::MapPoints submap = map_.submap(node, fleet_.view);
  EXPECT_EQ(submap.points.size(), 16u) << "a point a voxel";
  EXPECT_EQ(submap.stamp, stamp_from_ns(77));
}

TEST_F(MapBuilderTest, AMapOfOtherPosesNeedsNoSubmapAgain) {
  fleet_.view.placement.T_enu_node.at(node_id("r2", 0)).translation().y() += 7.0;
  const ros_codec::MapPoints whole = map_.whole(fleet_.view);
  ASSERT_EQ(whole.points.size(), 32u);
  EXPECT_NEAR(whole.points.back().p.y(), 7.0 + 1.55, 1e-5);
  fleet_.view.placement.T_enu_node.erase(node_id("r2", 0));
  EXPECT_EQ(map_.whole(fleet_.view).points.size(), 16u) << "without a place it is not on the map";
  EXPECT_TRUE(map_.submap(fleet_.view.nodes[1], fleet_.view).points.empty());
}

TEST_F(MapBuilderTest, AMapThatIsTooLargeIsThinnedAndStillCoversAll) {
  config_.map_points = 1000;
  MapBuilder map(config_, fleet_of_three_);
  map.add(node_id("r1", 0), square(60));
  map.add(node_id("r2", 0), square(60));
  const ros_codec::MapPoints whole = map.whole(fleet_.view);
  EXPECT_LE(whole.points.size(), 1000u);
  EXPECT_GT(whole.points.size(), 250u) << "not much thinner than asked for";
  const auto robots = std::ranges::count(whole.points, 1, &ros_codec::MapPoints::Point::robot);
  EXPECT_NEAR(static_cast<double>(robots), 0.5 * static_cast<double>(whole.points.size()),
              0.1 * static_cast<double>(whole.points.size()));
  EXPECT_GT(map.voxel(), config_.map_voxel) << "the next one begins there";
  EXPECT_EQ(map.whole(fleet_.view).points.size(), whole.points.size());
  EXPECT_GT(std::ranges::max(whole.points, {}, [](const auto& point) { return point.p.y(); }).p.y(), 28.0f);
}

}  // namespace
}  // namespace fleetmap::ros_output
