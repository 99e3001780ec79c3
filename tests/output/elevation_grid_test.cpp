#include "elevation_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace fleetmap::output {
namespace {

using ::testing::HasSubstr;
using Points = std::vector<Eigen::Vector3d>;

ElevationRaster raster_of(const Points& points, const ElevationConfig& config = {}) {
  ElevationGrid grid(config);
  grid.add(points);
  const Status found = grid.find_ground();
  EXPECT_TRUE(found) << found.error().message;
  grid.add_to_ground(points);
  return grid.take();
}

double terrain(double x, double y) { return 100.0 + 0.05 * x - 0.03 * y; }

/// 40 m x 20 m of sloped ground with noise, under one wall of 3 m from x = 20 to 21.
Points site(double sigma) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, sigma);
  Points points;
  for (double x = 0.05; x < 40.0; x += 0.1) {
    for (double y = 0.05; y < 20.0; y += 0.1) {
      const bool wall = x > 20.0 && x < 21.0;
      points.emplace_back(x, y, terrain(x, y) + (wall ? 3.0 : 0.0) + noise(random));
    }
  }
  return points;
}

TEST(ElevationGrid, TheGroundIsTheMeanOfItsPointsWithoutWhatStandsOnIt) {
  constexpr double kSigma = 0.03;
  const ElevationRaster raster = raster_of(site(kSigma));
  ASSERT_EQ(raster.width, 80);
  ASSERT_EQ(raster.height, 40);
  EXPECT_EQ(raster.west, 0.0);
  EXPECT_EQ(raster.north, 20.0);
  double worst = 0.0, sum = 0.0;
  int cells = 0;
  for (int row = 0; row < raster.height; ++row) {
    for (int column = 0; column < raster.width; ++column) {
      const double x = 0.25 + 0.5 * column, y = 20.0 - 0.25 - 0.5 * row;
      const auto index = static_cast<std::size_t>(row * raster.width + column);
      const bool wall = x > 20.0 && x < 21.0;
      EXPECT_EQ(std::isnan(raster.ground[index]), wall) << x << ' ' << y;
      EXPECT_NEAR(raster.surface[index], terrain(x, y) + (wall ? 3.0 : 0.0), 4.0 * kSigma);
      if (wall) continue;
      const double error = static_cast<double>(raster.ground[index]) - terrain(x, y);
      worst = std::max(worst, std::abs(error));
      sum += error;
      ++cells;
    }
  }
  // 25 points a cell: sigma / 5 each, of which 3,000 draws stay within 4.5; and no bias, as a low quantile
  // has.
  EXPECT_LT(worst, 4.5 * kSigma / 5.0);
  EXPECT_LT(std::abs(sum / cells), 0.1 * kSigma);
}

TEST(ElevationGrid, RastersOfOtherPointsLieOnTheSameCells) {
  const ElevationRaster raster = raster_of({{1000.3, -2000.7, 5.0}, {1001.9, -1999.2, 6.0}});
  EXPECT_EQ(raster.west, 1000.0);
  EXPECT_EQ(raster.north, -1999.0);
  EXPECT_EQ(raster.width, 4);
  EXPECT_EQ(raster.height, 4);
  EXPECT_EQ(raster.ground[12], 5.0f) << "south-west";
  EXPECT_EQ(raster.surface[3], 6.0f) << "north-east";
  EXPECT_TRUE(std::isnan(raster.surface[0]));
}

TEST(ElevationGrid, PointsThatAreNewInTheSecondPassDoNotLeaveTheRaster) {
  const Points points = site(0.03);
  ElevationGrid grid({});
  grid.add(points);
  ASSERT_TRUE(grid.find_ground());
  grid.add_to_ground(points);
  grid.add_to_ground(std::vector<Eigen::Vector3d>{{-30.0, 5.0, 100.0}, {1e4, 5.0, 100.0}, {5.0, 5e6, 100.0}});
  const ElevationRaster raster = grid.take(), sound = raster_of(points);
  for (std::size_t k = 0; k < sound.ground.size(); ++k) {
    EXPECT_TRUE(raster.ground[k] == sound.ground[k] ||
                (std::isnan(raster.ground[k]) && std::isnan(sound.ground[k])));
  }
}

TEST(ElevationGrid, OneStrayPointIsNeitherTheLowestNorTheHighest) {
  Points points;
  for (int k = 0; k < 40; ++k) points.emplace_back(0.1 + 0.005 * k, 0.25, 1.0);
  points.emplace_back(0.2, 0.2, -3.0);
  points.emplace_back(0.2, 0.2, 9.0);
  const ElevationRaster raster = raster_of(points);
  EXPECT_EQ(raster.ground[0], 1.0f);
  EXPECT_EQ(raster.surface[0], 1.0f);
}

TEST(ElevationGrid, ARasterThatIsTooLargeIsRefusedWithTheRemedy) {
  ElevationGrid empty({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  empty.add(Points{{nan, 0.0, 0.0}, {1e300, 0.0, 0.0}});
  EXPECT_THAT(empty.find_ground().error().message, HasSubstr("no points"));
  ElevationGrid grid({});
  grid.add(Points{{-90'000.0, 0.0, 0.0}, {90'000.0, 90'000.0, 0.0}});
  EXPECT_THAT(grid.find_ground().error().message, HasSubstr("larger cells (--cell)"));
}

TEST(ElevationConfig, RefusesCellsThatAreNoCells) {
  EXPECT_TRUE(ElevationConfig{}.validate());
  EXPECT_FALSE(ElevationConfig{.cell_m = 0.0}.validate());
  EXPECT_FALSE(ElevationConfig{.cell_m = std::numeric_limits<double>::quiet_NaN()}.validate());
  EXPECT_FALSE(ElevationConfig{.max_step_m = 0.1}.validate());
}

}  // namespace
}  // namespace fleetmap::output
