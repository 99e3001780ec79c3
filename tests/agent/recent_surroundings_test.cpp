#include "fleetmap/agent/recent_surroundings.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace fleetmap::agent {
namespace {

/// Points of a pole of 3 m at (x, y) on the ground, half a metre apart.
cloud::PointCloud pole(float x, float y) {
  cloud::PointCloud cloud;
  for (int k = 0; k < 7; ++k) cloud.points.emplace_back(x, y, 0.5f * static_cast<float>(k));
  return cloud;
}
cloud::PointCloud joined(std::initializer_list<cloud::PointCloud> clouds) {
  cloud::PointCloud all;
  for (const cloud::PointCloud& cloud : clouds)
    all.points.insert(all.points.end(), cloud.points.begin(), cloud.points.end());
  return all;
}
Pose pose_at(double x, double y, double yaw = 0.0) {
  return make_pose(rotation_from_rpy(0, 0, yaw), {x, y, 0});
}
/// The descriptor of the surroundings as seen from `T_odom_base`.
place::Descriptor of(const RecentSurroundings& recent, const Pose& T_odom_base) {
  return recent.describe(T_odom_base, Eigen::Vector3d::UnitZ());
}
place::Descriptor of(const cloud::PointCloud& points_in_base) {
  return place::Descriptor::of(points_in_base.points, Eigen::Vector3d::UnitZ());
}

TEST(RecentSurroundings, NoSubmapsGiveAnEmptyDescriptor) {
  EXPECT_EQ(of(RecentSurroundings(), pose_at(0, 0)), place::Descriptor());
}

TEST(RecentSurroundings, AreAllSubmapsTogetherAsSeenFromTheNode) {
  RecentSurroundings recent;
  recent.add(pole(11, 1), {0, 0, 0});
  recent.add(pole(1, 6), {5, 0, 0});
  EXPECT_EQ(of(recent, pose_at(0, 0)), of(joined({pole(11, 1), pole(1, 6)})));
  EXPECT_EQ(of(recent, pose_at(10, 0)), of(joined({pole(1, 1), pole(-9, 6)})));
  EXPECT_EQ(of(recent, pose_at(0, 0, std::numbers::pi / 2)), of(joined({pole(1, -11), pole(6, -1)})))
      << "ahead is north";
  EXPECT_EQ(of(recent, pose_at(0, 0)).observed(), 2);
  EXPECT_EQ(of(recent, pose_at(0, 0)).occupied(), 2);
}

TEST(RecentSurroundings, EndThirtyMetresBehind) {
  RecentSurroundings recent;
  recent.add(pole(1, 1), {0, 0, 0});
  recent.add(pole(6, 1), {29.9, 0, 0});
  EXPECT_EQ(of(recent, pose_at(0, 0)), of(joined({pole(1, 1), pole(6, 1)})));
  recent.add(pole(11, 1), {30.1, 0, 0});
  EXPECT_EQ(of(recent, pose_at(0, 0)), of(joined({pole(6, 1), pole(11, 1)})));
}

TEST(RecentSurroundings, AreOfTheLastTwelveSubmaps) {
  RecentSurroundings recent;
  for (int k = 0; k < 13; ++k) recent.add(pole(1.0f + 2.5f * static_cast<float>(k), 1.0f), {0, 0, 0});
  EXPECT_EQ(of(recent, pose_at(0, 0)).observed(), 12);
  EXPECT_EQ(of(recent, pose_at(30, 0)).observed(), 12);
  recent.clear();
  EXPECT_EQ(of(recent, pose_at(0, 0)), place::Descriptor());
}

TEST(RecentSurroundings, DensePointsAreThinnedButAllCellsStay) {
  RecentSurroundings recent;
  cloud::PointCloud dense;
  for (float x = 0.05f; x < 10.0f; x += 0.1f) {
    for (float y = 0.05f; y < 5.0f; y += 0.1f) dense.points.emplace_back(x, y, 0.0f);
  }
  recent.add(dense, {0, 0, 0});
  EXPECT_EQ(of(recent, pose_at(0, 0)), of(dense));
  EXPECT_EQ(of(recent, pose_at(0, 0)).observed(), 8) << "4 x 2 cells of 2.5 m";
}

}  // namespace
}  // namespace fleetmap::agent
