#include "fleetmap/cloud/outliers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::cloud {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

PointCloud on_a_line(std::initializer_list<float> places) {
  PointCloud cloud;
  for (const float x : places) cloud.points.emplace_back(x, 2.0f, -1.0f);
  return cloud;
}

/// Nearest distances are 1, 1, 1, 1 and 7: their mean is 2.2 and their standard deviation, over n - 1, 2.683.
/// The limit of the last one lies at 1.789 sigmas; over n it would be 2.
TEST(SplitOutliers, TheLimitIsMeanPlusSigmasTimesTheSampleDeviation) {
  const PointCloud cloud = on_a_line({0, 1, 2, 3, 10});
  EXPECT_THAT(split_outliers(cloud, {1, 1.78}).removed, ElementsAre(4));
  EXPECT_THAT(split_outliers(cloud, {1, 1.80}).removed, IsEmpty());
  EXPECT_THAT(split_outliers(cloud, {1, 1.78}).kept, ElementsAre(0, 1, 2, 3));
}

TEST(SplitOutliers, TheDistanceIsTheMeanOverTheNeighbours) {
  // Means over two neighbours: 1.5, 1, 1, 1.5 and 7.5.
  const PointCloud cloud = on_a_line({0, 1, 2, 3, 10});
  EXPECT_THAT(split_outliers(cloud, {2, 0.0}).removed, ElementsAre(4));
  // Over all four: 4, 3.25, 3, 3.25 and 8.5, of which the mean is 4.4 and the deviation 2.322.
  EXPECT_THAT(split_outliers(cloud, {4, 1.76}).removed, ElementsAre(4));
  EXPECT_THAT(split_outliers(cloud, {4, 1.78}).removed, IsEmpty());
  EXPECT_EQ(split_outliers(cloud, {20, 1.76}).removed, split_outliers(cloud, {4, 1.76}).removed)
      << "more neighbours than there are points";
}

TEST(SplitOutliers, EqualDistancesAreNoOutliersEvenWithoutTolerance) {
  EXPECT_THAT(split_outliers(on_a_line({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), {1, 0.0}).removed, IsEmpty());
  EXPECT_THAT(split_outliers(on_a_line({4, 4, 4, 4}), {2, 0.0}).removed, IsEmpty());
  EXPECT_THAT(split_outliers(on_a_line({-3, 5}), {10, 0.0}).removed, IsEmpty());
}

TEST(SplitOutliers, NonFinitePointsGoAndChangeNothingElse) {
  PointCloud cloud = on_a_line({0, 1, 2, 3, 10});
  cloud.points.insert(cloud.points.begin() + 2, {0.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f});
  cloud.points.insert(cloud.points.begin(), {std::numeric_limits<float>::infinity(), 0.0f, 0.0f});
  EXPECT_THAT(split_outliers(cloud, {1, 1.78}).removed, ElementsAre(0, 3, 6));
  EXPECT_THAT(split_outliers(cloud, {1, 1.80}).removed, ElementsAre(0, 3));
  EXPECT_THAT(split_outliers(cloud, {1, 1.80}).kept, ElementsAre(1, 2, 4, 5, 6));
}

}  // namespace
}  // namespace fleetmap::cloud
