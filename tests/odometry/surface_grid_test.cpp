#include "fleetmap/odometry/surface_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fleetmap::odometry {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using ObservedPoint = SurfaceGrid::ObservedPoint;
using Seeks = SurfaceGrid::Seeks;

constexpr double kStep = 0.5;
const Vector3f kUp = Vector3f::UnitZ(), kNoSide = Vector3f::Zero();
/// Variance of ten places 0.1 m apart, as those of ground() and line() within one window are.
constexpr double kSpread = 0.01 * 99.0 / 12.0;

SurfaceGrid planes(double max_thickness = 0.08, double unevenness = 0.0) {
  return SurfaceGrid(kStep, Seeks::kPlanes, max_thickness, unevenness);
}

/// 2 m x 2 m around the origin at `height`, every other point higher or lower by `roughness`. The window at
/// the origin, 1 m wide, holds 100 of the points.
std::vector<ObservedPoint> ground(double height, double roughness, const Vector3f& toward) {
  std::vector<ObservedPoint> points;
  for (int x = -10; x < 10; ++x) {
    for (int y = -10; y < 10; ++y) {
      const double z = height + ((x + y) % 2 == 0 ? roughness : -roughness);
      points.push_back({{0.1 * x + 0.05, 0.1 * y + 0.05, z}, toward});
    }
  }
  return points;
}

/// 2 m along `axis` through the point at which all coordinates are 0.1.
std::vector<ObservedPoint> line(int axis) {
  std::vector<ObservedPoint> points;
  for (int k = -10; k < 10; ++k) {
    Vector3d p(0.1, 0.1, 0.1);
    p[axis] = 0.1 * k + 0.05;
    points.push_back({p, kNoSide});
  }
  return points;
}

TEST(SurfaceGrid, FitsAPlaneWithItsThicknessAndTheUncertaintyOfItsNormal) {
  SurfaceGrid grid = planes(0.08, 0.1);
  grid.add(ground(0.1, 0.02, kUp));
  const Surface* surface = grid.at({0.1, -0.1, 0.2}, kUp);
  ASSERT_NE(surface, nullptr);
  EXPECT_EQ(surface->shape, Shape::kPlane);
  EXPECT_LT((surface->mean - Vector3d(0, 0, 0.1)).norm(), 1e-5);
  EXPECT_GT(surface->direction.z(), 0.9999f);
  EXPECT_EQ(surface->count, 100.0f);
  EXPECT_NEAR(surface->thickness, 0.02 * 0.02 + 0.1 * 0.1, 1e-6) << "as rough as it is and may unevenness";
  EXPECT_NEAR(surface->angle_variance, 0.02 * 0.02 / (100.0 * kSpread), 1e-7);
}

TEST(SurfaceGrid, ANormalIsOnTheSideFromWhichItWasSeen) {
  for (const float side : {-1.0f, 1.0f}) {
    SurfaceGrid grid = planes();
    grid.add(ground(0.1, 0.0, Vector3f(0.6f, 0.0f, 0.8f * side)));
    const Surface* surface = grid.at({0, 0, 0}, side * kUp);
    ASSERT_NE(surface, nullptr);
    EXPECT_NEAR(surface->direction.z(), side, 1e-4f);
    EXPECT_EQ(grid.at({0, 0, 0}, -side * kUp), nullptr) << "nobody saw its other side";
  }
}

TEST(SurfaceGrid, ThickOrNarrowSurfacesAreNoPlanes) {
  const auto shape_of = [](const std::vector<ObservedPoint>& points) {
    SurfaceGrid grid = planes(0.03);
    grid.add(points);
    return grid.at({0, 0, 0}, kUp)->shape;
  };
  EXPECT_EQ(shape_of(ground(0.1, 0.025, kUp)), Shape::kPlane);
  EXPECT_EQ(shape_of(ground(0.1, 0.035, kUp)), Shape::kScatter);
  EXPECT_EQ(shape_of(line(0)), Shape::kUnknown) << "one ring on a floor";
  std::vector<ObservedPoint> few{{{0.3, 0.3, 0.0}, kUp},   {{-0.3, 0.3, 0.0}, kUp}, {{0.3, -0.3, 0.0}, kUp},
                                 {{-0.3, -0.3, 0.0}, kUp}, {{0.1, 0.2, 0.0}, kUp},  {{-0.2, 0.1, 0.0}, kUp}};
  EXPECT_EQ(shape_of(few), Shape::kUnknown);
  few.push_back({{0.2, -0.1, 0.0}, kUp});
  EXPECT_EQ(shape_of(few), Shape::kPlane);
}

TEST(SurfaceGrid, LinesLieInAnyDirectionAndPostsStand) {
  for (const int axis : {0, 1, 2}) {
    SurfaceGrid lines(kStep, Seeks::kLines, 0.1, 0.0), posts(kStep, Seeks::kUprightLines, 0.1, 0.0);
    lines.add(line(axis));
    posts.add(line(axis));
    const Surface* surface = lines.at({0, 0, 0}, kNoSide);
    ASSERT_NE(surface, nullptr);
    EXPECT_EQ(surface->shape, Shape::kLine);
    EXPECT_GT(std::abs(surface->direction[axis]), 0.9999f);
    EXPECT_LT((surface->mean - (0.1 * Vector3d::Ones() - 0.1 * Vector3d::Unit(axis))).norm(), 1e-5);
    EXPECT_EQ(posts.at({0, 0, 0}, kNoSide)->shape, axis == 2 ? Shape::kLine : Shape::kScatter) << axis;
  }
}

TEST(SurfaceGrid, APointIsInEightWindowsAndTheNearestIsLookedUp) {
  SurfaceGrid grid = planes();
  const ObservedPoint inside{{0.2, 0.2, 0.2}, kUp}, beside{{0.7, 0.2, 0.2}, kUp};
  grid.add({&inside, 1});
  EXPECT_EQ(grid.size(), 8u);
  grid.add({&inside, 1});
  EXPECT_EQ(grid.size(), 8u);
  grid.add({&beside, 1});
  EXPECT_EQ(grid.size(), 12u);
  EXPECT_EQ(grid.cell_at({0.24, -0.24, 0.26}), pack_cell(0, 0, 1));
  EXPECT_EQ(grid.cell_at({-0.26, -0.74, 0.76}), pack_cell(-1, -1, 2));
  EXPECT_EQ(grid.at({0.2, 0.2, 0.2}, kUp)->count, 2.0f);
  EXPECT_EQ(grid.at({0.5, 0.2, 0.2}, kUp)->count, 3.0f);
  EXPECT_EQ(grid.at({1.0, 0.2, 0.2}, kUp)->count, 1.0f);
  EXPECT_EQ(grid.at({1.3, 0.2, 0.2}, kUp), nullptr);
}

TEST(SurfaceGrid, IsFittedAnewOnceItHasGrownAndStopsGrowing) {
  SurfaceGrid grid = planes();
  grid.add(ground(0.1, 0.0, kUp));
  const auto count = [&] { return grid.at({0, 0, 0}, kUp)->count; };
  EXPECT_EQ(count(), 100.0f);
  const std::vector<ObservedPoint> more(4, {{0.1, 0.1, 0.1}, kUp}), two(2, more[0]);
  grid.add(more);
  EXPECT_EQ(count(), 100.0f) << "four of a hundred change little";
  grid.add(two);
  EXPECT_EQ(count(), 106.0f);
  grid.add(ground(0.1, 0.0, kUp));
  grid.add(std::vector<ObservedPoint>(200, {{0.1, 0.1, 0.4}, kUp}));
  EXPECT_EQ(count(), 250.0f);
  const double height = grid.at({0, 0, 0}, kUp)->mean.z();
  grid.add(std::vector<ObservedPoint>(500, {{0.1, 0.1, -0.4}, kUp}));
  EXPECT_EQ(grid.at({0, 0, 0}, kUp)->mean.z(), height) << "what was seen first is the anchor";
}

TEST(SurfaceGrid, APlaneIsKnownOnceItWasLookedUp) {
  SurfaceGrid grid = planes();
  grid.add(ground(0.1, 0.0, kUp));
  EXPECT_FALSE(grid.known_plane({0, 0, 0}));
  grid.at({0, 0, 0}, kUp);
  EXPECT_TRUE(grid.known_plane({0.2, 0.1, -0.2}));
  EXPECT_FALSE(grid.known_plane({0.5, 0, 0})) << "another window";
  EXPECT_FALSE(grid.known_plane({90, 0, 0}));
}

TEST(SurfaceGrid, PruningForgetsWhatIsFarAndKeepsTheRestAsItWas) {
  SurfaceGrid grid = planes();
  std::vector<ObservedPoint> points = ground(0.1, 0.02, kUp);
  for (const ObservedPoint& p : ground(0.1, 0.02, kUp)) points.push_back({p.point + Vector3d(50, 0, 0), kUp});
  grid.add(points);
  const Surface before = *grid.at({50, 0, 0}, kUp);
  grid.at({0, 0, 0}, kUp);
  const std::size_t both = grid.size();
  grid.prune({50, 0, 0}, 10.0);
  EXPECT_EQ(2 * grid.size(), both);
  EXPECT_EQ(grid.at({0, 0, 0}, kUp), nullptr);
  const Surface* after = grid.at({50, 0, 0}, kUp);
  ASSERT_NE(after, nullptr);
  EXPECT_EQ(after->mean, before.mean);
  EXPECT_EQ(after->direction, before.direction);
  EXPECT_EQ(after->count, before.count);
  grid.add(ground(0.1, 0.0, kUp));
  EXPECT_EQ(grid.at({0, 0, 0}, kUp)->count, 100.0f) << "it can be seen again";
  grid.clear();
  EXPECT_EQ(grid.windows(), 0u);
  EXPECT_EQ(grid.at({50, 0, 0}, kUp), nullptr);
}

}  // namespace
}  // namespace fleetmap::odometry
