#include "sim/solar_farm_layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::sim {
namespace {

using ::testing::ElementsAre;

/// 70 x 60 m, 10 m tables of 4 m, roads after every second one.
SolarFarmConfig farm() {
  SolarFarmConfig config;
  config.size_east = 70.0;
  config.size_north = 60.0;
  config.headland = 8.0;
  config.row_pitch = 7.0;
  config.table_length = 10.0;
  config.table_gap = 0.4;
  config.road_every = 2;
  config.road_width = 6.0;
  config.missing_tables = 0.0;
  config.cabins = config.trees = config.trees_inside = 0;
  return config;
}

std::size_t count_of(const SolarFarmLayout& layout, TableSlot slot) {
  std::size_t count = 0;
  for (const auto& row : layout.places) count += static_cast<std::size_t>(std::ranges::count(row, slot));
  return count;
}

TEST(SolarFarmLayout, TablesFillTheSiteBetweenItsHeadlands) {
  // 54 m hold 10 + 0.4 + 10 + 6 + 10 + 0.4 + 10 = 46.8 m; the fifth would need 16 m more.
  EXPECT_EQ(tables_that_fit(farm()), 4);
  // 44 m less the depth of 4 cos(0.426) + 0.04 = 3.683 m leave five pitches of 7 m.
  EXPECT_NEAR(table_depth(farm()), 4.0 * std::cos(0.426) + 0.04, 1e-12);
  EXPECT_EQ(rows_that_fit(farm()), 6);
  const SolarFarmLayout layout = lay_out(farm());
  EXPECT_THAT(layout.rows, ElementsAre(-17.5, -10.5, -3.5, 3.5, 10.5, 17.5));
  ASSERT_EQ(layout.tables.size(), 4u);
  const double expected[] = {-18.4, -8.0, 8.0, 18.4};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(layout.tables[k], expected[k], 1e-9);
  EXPECT_EQ(layout.beside_road, std::vector<bool>(4, true));
  EXPECT_EQ(count_of(layout, TableSlot::kTable), 24u);
  EXPECT_EQ(layout.half_site, Eigen::Vector2d(35.0, 30.0));
}

TEST(SolarFarmLayout, WithoutRoadsOnlyTheEndsAreBesideOne) {
  SolarFarmConfig config = farm();
  config.road_every = 0;
  EXPECT_EQ(tables_that_fit(config), 5) << "51.6 m";
  EXPECT_EQ(lay_out(config).beside_road, (std::vector<bool>{true, false, false, false, true}));
  config.size_east = 25.0;
  EXPECT_EQ(tables_that_fit(config), 0);
  config.size_north = 19.0;
  EXPECT_EQ(rows_that_fit(config), 0);
  config.size_north = 20.0;
  EXPECT_EQ(rows_that_fit(config), 1);
}

TEST(SolarFarmLayout, TheFrameTurnsWithTheAzimuthOfTheRows) {
  SolarFarmConfig config = farm();
  config.row_azimuth_rad = std::numbers::pi / 2;
  EXPECT_EQ(lay_out(config).direction, Eigen::Vector2d(1.0, 0.0)) << "exactly east";
  config.row_azimuth_rad = 0.0;
  EXPECT_TRUE(lay_out(config).enu({3.0, 2.0}).isApprox(Eigen::Vector2d(-2.0, 3.0))) << "u north, v west";
  config.row_azimuth_rad = std::numbers::pi / 6;
  EXPECT_TRUE(lay_out(config).enu({1.0, 0.0}).isApprox(Eigen::Vector2d(0.5, std::sqrt(0.75)), 1e-12));
}

TEST(SolarFarmLayout, TheShareOfTablesIsMissing) {
  SolarFarmConfig config = farm();
  config.size_east = config.size_north = 400.0;
  config.missing_tables = 0.2;
  const SolarFarmLayout layout = lay_out(config);
  const double all = static_cast<double>(layout.rows.size() * layout.tables.size());
  EXPECT_GT(all, 1000.0);
  EXPECT_NEAR(static_cast<double>(count_of(layout, TableSlot::kEmpty)) / all, 0.2, 0.04);
  config.missing_tables = 1.0;
  EXPECT_EQ(count_of(lay_out(config), TableSlot::kTable), 0u);
}

TEST(SolarFarmLayout, CabinsStandBesideRoadsAsManyAsThereIsRoomFor) {
  SolarFarmConfig config = farm();
  config.road_every = 0;
  config.cabins = 3;
  const SolarFarmLayout layout = lay_out(config);
  EXPECT_EQ(count_of(layout, TableSlot::kCabin), 3u);
  for (const auto& row : layout.places) {
    for (std::size_t k = 1; k < 4; ++k) EXPECT_EQ(row[k], TableSlot::kTable);
  }
  config.cabins = 1000;
  EXPECT_EQ(count_of(lay_out(config), TableSlot::kCabin), 12u) << "both ends of six rows";
  EXPECT_EQ(cabin_size(config).x(), 6.0);
  config.table_length = 5.0;
  EXPECT_EQ(cabin_size(config).x(), 5.0) << "no longer than the table that it replaces";
}

TEST(SolarFarmLayout, TreesStandOutsideTheFenceOrInTheRows) {
  SolarFarmConfig config = farm();
  config.trees = 200;
  config.trees_inside = 200;
  const SolarFarmLayout layout = lay_out(config);
  ASSERT_EQ(layout.trees.size(), 400u);
  int sides[4] = {};
  for (std::size_t k = 0; k < 200; ++k) {
    const Eigen::Vector2d beyond = layout.trees[k].center.cwiseAbs() - layout.half_site;
    EXPECT_GE(beyond.maxCoeff(), 2.4 - 1e-9) << "a crown";
    EXPECT_LE(beyond.maxCoeff(), config.margin - 2.4 + 1e-9);
    EXPECT_LE(beyond.minCoeff(), 0.0);
    const bool east_or_west = beyond.x() > beyond.y();
    ++sides[(east_or_west ? 0 : 2) + (layout.trees[k].center[east_or_west ? 0 : 1] > 0.0 ? 1 : 0)];
  }
  for (const int trees : sides) EXPECT_GT(trees, 25);
  for (std::size_t k = 200; k < 400; ++k) {
    const Eigen::Vector2d& p = layout.trees[k].center;
    EXPECT_LE(std::abs(p.x()), 23.4);
    EXPECT_TRUE(std::ranges::any_of(
        layout.rows, [&](double v) { return std::abs(p.y() - v) <= layout.depth / 2 + 1e-9; }));
  }
}

TEST(DrawingOf, RowsAreBlocksBetweenRoadsAndCabins) {
  SolarFarmConfig config = farm();
  const SolarFarmLayout layout = lay_out(config);
  const SiteDrawing drawing = drawing_of(config, layout);
  ASSERT_EQ(drawing.keep_out.size(), 12u) << "six rows, a road through each";
  const double v = layout.depth / 2 + 0.05;
  EXPECT_TRUE(drawing.keep_out[0][0].isApprox(Eigen::Vector2d(-23.45, -17.5 - v), 1e-9));
  EXPECT_TRUE(drawing.keep_out[0][2].isApprox(Eigen::Vector2d(-2.95, -17.5 + v), 1e-9));
  SolarFarmLayout with_cabin = layout;
  with_cabin.places[0][0] = TableSlot::kCabin;
  with_cabin.places[0][1] = TableSlot::kEmpty;
  const SiteDrawing changed = drawing_of(config, with_cabin);
  ASSERT_EQ(changed.keep_out.size(), 13u);
  EXPECT_NEAR((changed.keep_out[0][1] - changed.keep_out[0][0]).norm(), 6.1, 1e-9) << "a cabin and its rim";
  EXPECT_NEAR((changed.keep_out[1][1] - changed.keep_out[1][0]).norm(), 10.1, 1e-9)
      << "a table that is missing";
}

TEST(DrawingOf, LanesRunBetweenTheRowsAndOutside) {
  const SolarFarmConfig config = farm();
  const SolarFarmLayout layout = lay_out(config);
  const SiteDrawing drawing = drawing_of(config, layout);
  ASSERT_EQ(drawing.lanes.size(), 7u);
  const double expected[] = {-21.0, -14.0, -7.0, 0.0, 7.0, 14.0, 21.0};
  for (std::size_t k = 0; k < 7; ++k) {
    EXPECT_NEAR(drawing.lanes[k].from.y(), expected[k], 1e-9);
    EXPECT_NEAR(drawing.lanes[k].from.x(), -27.4, 1e-9) << "half of the headland beyond the tables";
    EXPECT_TRUE(drawing.lanes[k].to.isApprox(Eigen::Vector2d(27.4, expected[k]), 1e-9));
  }
}

TEST(DrawingOf, TheBoundaryIsTheFenceOrTheEdgeOfTheGround) {
  SolarFarmConfig config = farm();
  EXPECT_EQ(drawing_of(config, lay_out(config)).boundary[2], Eigen::Vector2d(35.0, 30.0));
  config.fence.enabled = false;
  EXPECT_EQ(drawing_of(config, lay_out(config)).boundary[2], Eigen::Vector2d(50.0, 45.0));
}

}  // namespace
}  // namespace fleetmap::sim
