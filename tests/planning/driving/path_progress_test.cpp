#include "driving/path_progress.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;

/// There, a turn and back 3 m beside.
const Polyline kThereAndBack = {{0, 0}, {20, 0}, {20, 3}, {0, 3}};

TEST(PathProgress, PointsAndTangentsFollowThePath) {
  const PathProgress path(kThereAndBack);
  EXPECT_DOUBLE_EQ(path.length(), 43.0);
  EXPECT_LT((path.point(5.0) - Vector2d(5, 0)).norm(), 1e-12);
  EXPECT_LT((path.point(21.0) - Vector2d(20, 1)).norm(), 1e-12);
  EXPECT_LT((path.tangent(30.0) - Vector2d(-1, 0)).norm(), 1e-12);
  EXPECT_LT((path.point(99.0) - Vector2d(0, 3)).norm(), 1e-12);
}

TEST(PathProgress, AnEmptyPathHasNoLength) {
  EXPECT_TRUE(PathProgress().empty());
  EXPECT_TRUE(PathProgress({{1, 1}, {1, 1.01}}).empty());  // one point
  const PathProgress path({{0, 0}, {NAN, 0}, {10, 0}});
  EXPECT_DOUBLE_EQ(path.length(), 10.0);
}

TEST(PathProgress, ItNeverJumpsToAParallelPartPastACorner) {
  PathProgress path(kThereAndBack);
  for (double x = 0.0; x <= 15.0; x += 0.5) {
    path.advance({x, 2.0}, 0.8, 4.0);  // nearer to the way back
    EXPECT_NEAR(path.along(), x, 1e-9);
  }
  EXPECT_DOUBLE_EQ(path.next_corner(), 20.0);
}

TEST(PathProgress, ACornerIsReachedWithinTheToleranceOrAbeam) {
  PathProgress near(kThereAndBack);
  for (double x = 0.0; x <= 19.5; x += 0.5) near.advance({x, 0.0}, 0.8, 4.0);
  EXPECT_DOUBLE_EQ(near.next_corner(), 23.0);
  PathProgress abeam(kThereAndBack);
  for (double x = 0.0; x <= 20.0; x += 0.5) abeam.advance({x, -2.0}, 0.8, 4.0);
  EXPECT_DOUBLE_EQ(abeam.next_corner(), 23.0);
  PathProgress too_far(kThereAndBack);
  for (double x = 0.0; x <= 20.0; x += 0.5) too_far.advance({x, -2.0}, 0.8, 1.0);
  EXPECT_DOUBLE_EQ(too_far.next_corner(), 20.0);
}

TEST(PathProgress, FlatBendsAreNoCorners) {
  const PathProgress path({{0, 0}, {10, 0}, {20, 2}});
  EXPECT_DOUBLE_EQ(path.next_corner(), path.length());
  PathProgress sharp(kThereAndBack);
  sharp.skip_corner();
  EXPECT_DOUBLE_EQ(sharp.along(), 20.0);
}

}  // namespace
}  // namespace fleetmap::planning
