#include "fleetmap/sim/solar_farm_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = SolarFarmConfig;

TEST(SolarFarmConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(SolarFarmConfig, NumbersLieInTheirRanges) {
  for (const auto& [field, name] : {std::pair{&Config::size_east, "size_east"},
                                    {&Config::size_north, "size_north"},
                                    {&Config::margin, "margin"},
                                    {&Config::headland, "headland"},
                                    {&Config::row_pitch, "row_pitch"},
                                    {&Config::table_length, "table_length"},
                                    {&Config::table_width, "table_width"},
                                    {&Config::table_gap, "table_gap"},
                                    {&Config::lower_edge_height, "lower_edge_height"},
                                    {&Config::post_spacing, "post_spacing"},
                                    {&Config::missing_tables, "missing_tables"},
                                    {&Config::road_width, "road_width"},
                                    {&Config::terrain_cell, "terrain_cell"}}) {
    expect_refused(Config{}, field, {-0.1, 1001.0, kNaN<double>}, name);
  }
  expect_refused(Config{}, &Config::cabins, {-1, 1001}, "cabins");
  expect_refused(Config{}, &Config::trees, {-1, 5001}, "trees");
}

TEST(SolarFarmConfig, ARobotFitsBetweenTheRows) {
  Config config;
  config.tilt_rad = 0.0;  // tables are as deep as they are wide, 4 m and what a mesh is thick
  expect_accepted(config, &Config::row_pitch, {5.55});
  expect_refused(config, &Config::row_pitch, {5.49}, "a robot needs 1.5 m");
}

TEST(SolarFarmConfig, TwoRowsOfOneTableFitIn) {
  Config config;
  config.size_east = config.size_north = 60.0;
  EXPECT_TRUE(config.validate());
  expect_refused(
      config, [](Config& c) { c.size_east = 25.0; }, "fewer than two rows");
  expect_refused(
      config, [](Config& c) { c.size_north = 25.0; }, "fewer than two rows");
}

TEST(SolarFarmConfig, TheMeshStaysBounded) {
  expect_refused(
      Config{},
      [](Config& c) {
        c.size_east = c.size_north = 1000.0;
        c.terrain_cell = 0.3;
      },
      "8 million cells");
  expect_refused(
      Config{},
      [](Config& c) {
        c.size_east = c.size_north = 1000.0;
        c.row_pitch = 2.1;
        c.table_width = 0.5;
        c.table_length = 1.0;
      },
      "100000 tables");
}

TEST(SolarFarmConfig, TreesStandOutsideTheFence) {
  Config config;
  config.margin = 5.0;
  EXPECT_TRUE(config.validate());
  expect_refused(
      config, [](Config& c) { c.margin = 4.9; }, "margin must be at least 5 m");
  config.trees = 0;
  expect_accepted(config, &Config::margin, {0.0});
}

TEST(SolarFarmConfig, ItsPartsAreCheckedAndNamed) {
  expect_refused(
      Config{}, [](Config& c) { c.fence.height = 0.0; }, "fence: height");
  expect_refused(
      Config{}, [](Config& c) { c.terrain.rolling_amplitude = -1.0; }, "terrain: rolling_amplitude");
  expect_refused(
      Config{}, [](Config& c) { c.drivable.cell = 0.0; }, "drivable: cell");
}

}  // namespace
}  // namespace fleetmap::sim
