#include "twin/twin_results.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

/// Flat ground of 60 m x 60 m with three lanes of 40 m to the east, 4 m apart.
std::shared_ptr<const sim::World> world_of_three_lanes() {
  sim::Mesh mesh;
  mesh.vertices = {{-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {sim::Material::kGround, sim::Material::kGround};
  sim::SiteDrawing drawing;
  for (const double y : {0.0, 4.0, 8.0}) drawing.lanes.push_back({{-20.0, y}, {20.0, y}});
  return sim::World::create(mesh, {}, drawing).value();
}

/// Along y from x to x, a pose every 0.1 m.
output::Trajectory along(double y, double from, double to) {
  output::Trajectory poses;
  const int steps = static_cast<int>(std::abs(to - from) / 0.1);
  for (int k = 0; k <= steps; ++k) {
    const double x = from + (to - from) * k / steps;
    poses.push_back(
        {stamp_from_ns(1'000'000LL * k), make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, y, 0))});
  }
  return poses;
}

TEST(ShareOfLanes, IsTheLengthThatSomeRobotDrove) {
  const auto world = world_of_three_lanes();
  EXPECT_EQ(share_of_lanes_driven(*world, 1, {}), 0.0);
  EXPECT_NEAR(*share_of_lanes_driven(*world, 1, {along(0.3, -20.0, 20.0)}), 1.0 / 3.0, 0.01);
  EXPECT_NEAR(*share_of_lanes_driven(*world, 1, {along(0.3, 20.0, 0.0)}), 0.5 / 3.0, 0.01) << "either way";
  EXPECT_NEAR(*share_of_lanes_driven(*world, 1, {along(0.0, -20.0, 0.0), along(0.5, -10.0, 20.0)}), 1.0 / 3.0,
              0.01)
      << "driven twice counts once";
}

TEST(ShareOfLanes, APoseIsOfTheNearestLaneWithinReach) {
  const auto world = world_of_three_lanes();
  EXPECT_NEAR(*share_of_lanes_driven(*world, 1, {along(2.2, -20.0, 20.0)}), 1.0 / 3.0, 0.01);
  EXPECT_NEAR(*share_of_lanes_driven(*world, 1, {along(12.9, -20.0, 20.0)}), 1.0 / 3.0, 0.01);
  EXPECT_EQ(share_of_lanes_driven(*world, 1, {along(13.1, -20.0, 20.0)}), 0.0);
  EXPECT_EQ(share_of_lanes_driven(*world, 1, {along(0.0, 20.6, 25.0)}), 0.0) << "beyond its end";
}

TEST(ShareOfLanes, OnlyTheLanesOfTheMissionCount) {
  const auto world = world_of_three_lanes();
  const std::vector<output::Trajectory> outer{along(0.0, -20.0, 20.0), along(8.0, -20.0, 20.0)};
  EXPECT_NEAR(*share_of_lanes_driven(*world, 2, outer), 1.0, 0.01);
  EXPECT_NEAR(*share_of_lanes_driven(*world, 1, outer), 2.0 / 3.0, 0.01);
}

TEST(ShareOfLanes, AWorldWithoutLanesHasNone) {
  sim::Mesh mesh = world_of_three_lanes()->mesh();
  EXPECT_EQ(share_of_lanes_driven(*sim::World::create(mesh).value(), 1, {along(0.0, -20.0, 20.0)}),
            std::nullopt);
}

TEST(TwinResults, TheTrueTrajectoryIsReadAsItWasWritten) {
  const testing::TemporaryFolder folder;
  const output::Trajectory truth = along(1.0, 0.0, 5.0);
  ASSERT_TRUE(write_truth(folder.path() / "r1", truth));
  const auto read = output::read_tum(folder.path() / "r1/truth.tum");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), truth.size());
  EXPECT_EQ(read->back().stamp, truth.back().stamp);
  EXPECT_TRUE(read->back().T_w_base.isApprox(truth.back().T_w_base, 1e-6));
  folder.write("file", "");
  EXPECT_FALSE(write_truth(folder.path() / "file/r1", truth));
}

}  // namespace
}  // namespace fleetmap::apps
