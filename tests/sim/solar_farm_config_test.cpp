#include "fleetmap/sim/solar_farm_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(SolarFarmConfig, DefaultsAreValid) { EXPECT_TRUE(SolarFarmConfig{}.validate()); }

TEST(SolarFarmConfig, NumbersLieInTheirRanges) {
  for (const auto& [field, name] : {std::pair{&SolarFarmConfig::size_east, "size_east"},
                                    {&SolarFarmConfig::size_north, "size_north"},
                                    {&SolarFarmConfig::margin, "margin"},
                                    {&SolarFarmConfig::headland, "headland"},
                                    {&SolarFarmConfig::row_pitch, "row_pitch"},
                                    {&SolarFarmConfig::table_length, "table_length"},
                                    {&SolarFarmConfig::table_width, "table_width"},
                                    {&SolarFarmConfig::table_gap, "table_gap"},
                                    {&SolarFarmConfig::lower_edge_height, "lower_edge_height"},
                                    {&SolarFarmConfig::post_spacing, "post_spacing"},
                                    {&SolarFarmConfig::missing_tables, "missing_tables"},
                                    {&SolarFarmConfig::road_width, "road_width"},
                                    {&SolarFarmConfig::terrain_cell, "terrain_cell"}}) {
    expect_refused(SolarFarmConfig{}, field, {-0.1, 1001.0, kNaN<double>}, name);
  }
  expect_refused(SolarFarmConfig{}, &SolarFarmConfig::cabins, {-1, 1001}, "cabins");
  expect_refused(SolarFarmConfig{}, &SolarFarmConfig::trees, {-1, 5001}, "trees");
}

TEST(SolarFarmConfig, ARobotFitsBetweenTheRows) {
  SolarFarmConfig config;
  config.tilt_rad = 0.0;  // tables are as deep as they are wide, 4 m and what a mesh is thick
  expect_accepted(config, &SolarFarmConfig::row_pitch, {5.55});
  expect_refused(config, &SolarFarmConfig::row_pitch, {5.49}, "a robot needs 1.5 m");
}

TEST(SolarFarmConfig, TwoRowsOfOneTableFitIn) {
  SolarFarmConfig config;
  config.size_east = config.size_north = 60.0;
  EXPECT_TRUE(config.validate());
  expect_refused(
      config, [](SolarFarmConfig& c) { c.size_east = 25.0; }, "fewer than two rows");
  expect_refused(
      config, [](SolarFarmConfig& c) { c.size_north = 25.0; }, "fewer than two rows");
}

TEST(SolarFarmConfig, TheMeshStaysBounded) {
  expect_refused(
      SolarFarmConfig{},
      [](SolarFarmConfig& c) {
        c.size_east = c.size_north = 1000.0;
        c.terrain_cell = 0.3;
      },
      "8 million cells");
  expect_refused(
      SolarFarmConfig{},
      [](SolarFarmConfig& c) {
        c.size_east = c.size_north = 1000.0;
        c.row_pitch = 2.1;
        c.table_width = 0.5;
        c.table_length = 1.0;
      },
      "100000 tables");
}

TEST(SolarFarmConfig, TreesStandOutsideTheFence) {
  SolarFarmConfig config;
  config.margin = 5.0;
  EXPECT_TRUE(config.validate());
  expect_refused(
      config, [](SolarFarmConfig& c) { c.margin = 4.9; }, "margin must be at least 5 m");
  config.trees = 0;
  expect_accepted(config, &SolarFarmConfig::margin, {0.0});
}

TEST(SolarFarmConfig, ItsPartsAreCheckedAndNamed) {
  expect_refused(
      SolarFarmConfig{}, [](SolarFarmConfig& c) { c.fence.height = 0.0; }, "fence: height");
  expect_refused(
      SolarFarmConfig{}, [](SolarFarmConfig& c) { c.terrain.rolling_amplitude = -1.0; },
      "terrain: rolling_amplitude");
  expect_refused(
      SolarFarmConfig{}, [](SolarFarmConfig& c) { c.drivable.cell = 0.0; }, "drivable: cell");
}

}  // namespace
}  // namespace fleetmap::sim
