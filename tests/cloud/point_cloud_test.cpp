#include "fleetmap/cloud/point_cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace fleetmap::cloud {
namespace {

using Eigen::Vector3f;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

PointCloud cloud_of(std::initializer_list<float> places, bool with_intensities) {
  PointCloud cloud;
  for (const float x : places) {
    cloud.points.emplace_back(x, 0.0f, 0.0f);
    if (with_intensities) cloud.intensities.push_back(10.0f * x);
  }
  return cloud;
}

std::vector<float> places_of(const PointCloud& cloud) {
  std::vector<float> places;
  for (const Vector3f& p : cloud.points) places.push_back(p.x());
  return places;
}

TEST(TransformedCloud, TurnsThenShifts) {
  PointCloud cloud = cloud_of({2.0f}, true);
  cloud.points.emplace_back(0.0f, 0.0f, 1.0f);
  cloud.intensities.push_back(7.0f);
  const Pose T =
      make_pose(rotation_from_rpy(0.0, 0.0, 0.5 * std::numbers::pi), Eigen::Vector3d(100, 200, 300));
  const PointCloud moved = transformed(cloud, T);
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_LT((moved.points[0] - Vector3f(100, 202, 300)).norm(), 1e-4f);
  EXPECT_LT((moved.points[1] - Vector3f(100, 200, 301)).norm(), 1e-4f);
  EXPECT_THAT(moved.intensities, ElementsAre(20.0f, 7.0f));
  EXPECT_FALSE(transformed(cloud_of({1.0f}, false), T).has_intensities());
}

/// There a float resolves 1/32 m, and 300000.02 alone would be rounded up.
TEST(TransformedCloud, IsRoundedOnce) {
  const Pose far = make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(300'000.02, 0.0, 0.0));
  EXPECT_EQ(transformed(cloud_of({0.02f}, false), far).points[0].x(), 300'000.03125f);
}

TEST(AppendedCloud, ComesAfterAndKeepsIntensitiesThatBothHave) {
  PointCloud both = cloud_of({1, 2}, true);
  append(both, cloud_of({3}, true));
  EXPECT_THAT(places_of(both), ElementsAre(1, 2, 3));
  EXPECT_THAT(both.intensities, ElementsAre(10, 20, 30));

  PointCloud first = cloud_of({1, 2}, true);
  append(first, cloud_of({3}, false));
  EXPECT_EQ(first.size(), 3u);
  EXPECT_THAT(first.intensities, IsEmpty());

  PointCloud second = cloud_of({1, 2}, false);
  append(second, cloud_of({3}, true));
  EXPECT_EQ(second.size(), 3u);
  EXPECT_THAT(second.intensities, IsEmpty());
}

TEST(AppendedCloud, EmptyOnesAreNeutral) {
  PointCloud onto_nothing;
  append(onto_nothing, cloud_of({4, 5}, true));
  EXPECT_THAT(places_of(onto_nothing), ElementsAre(4, 5));
  EXPECT_THAT(onto_nothing.intensities, ElementsAre(40, 50));
  append(onto_nothing, PointCloud{});
  EXPECT_THAT(places_of(onto_nothing), ElementsAre(4, 5));
  EXPECT_THAT(onto_nothing.intensities, ElementsAre(40, 50)) << "nothing lacks no intensities";
}

TEST(SelectedCloud, HasTheOrderOfTheIndicesAndMayRepeat) {
  const PointCloud some = select(cloud_of({0, 1, 2, 3}, true), {3, 0, 3});
  EXPECT_THAT(places_of(some), ElementsAre(3, 0, 3));
  EXPECT_THAT(some.intensities, ElementsAre(30, 0, 30));
  EXPECT_TRUE(select(cloud_of({0, 1}, true), {}).empty());
  EXPECT_FALSE(select(cloud_of({0, 1}, false), {1}).has_intensities());
}

TEST(NonFinitePoints, GoWithTheirIntensitiesAndTheRestKeepsItsOrder) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  PointCloud cloud = cloud_of({0, 1, 2, 3, 4}, true);
  cloud.points[0].x() = nan;
  cloud.points[2].y() = infinity;
  cloud.points[4].z() = -infinity;
  EXPECT_EQ(remove_non_finite(cloud), 3u);
  EXPECT_THAT(places_of(cloud), ElementsAre(1, 3));
  EXPECT_THAT(cloud.intensities, ElementsAre(10, 30));
  EXPECT_EQ(remove_non_finite(cloud), 0u);
  PointCloud bare = cloud_of({5, nan}, false);
  EXPECT_EQ(remove_non_finite(bare), 1u);
  EXPECT_THAT(bare.intensities, IsEmpty());
}

}  // namespace
}  // namespace fleetmap::cloud
