#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using MapCommand = testing::CommandLineTest;

TEST_F(MapCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"map"}, "A subcommand is required");
  expect_usage_error({"map", "info"}, "store is required");
  expect_usage_error({"map", "info", "s.db", "--origin", "39,-3"},
                     "--origin: At least 3 required but received 2");
  expect_usage_error({"map", "export", "s.db", "--out", ""}, "--out: is empty; give a path");
  expect_usage_error({"map", "export", "s.db", "--out", "m.las", "--tile", "0"},
                     "--tile: must be a whole number from 1 to 1000000");
  expect_usage_error({"map", "export", "s.db", "--out", "m.ply", "--voxel", "-1"},
                     "--voxel: must be a number from 0.001 to 1000, is -1");
  expect_usage_error({"map", "export", "s.db", "--out", "m", "--format", "geotiff", "--cell", "0"},
                     "--cell: must be a number from 0.05 to 1000, is 0");
  expect_usage_error({"map", "export", "s.db", "--out", "m.las", "--crs", "moon"}, "--crs: ");
  expect_usage_error({"map", "picture", "s.db", "--out", ""}, "--out: is empty; give a path");
  expect_usage_error({"map", "tracks", "s.db", "--out", "t.kml"}, "t.kml: must end with .gpx or .geojson");
  expect_usage_error({"map", "graph", "s.db", "--out", "g.txt"}, "g.txt: must end with .g2o");
}

}  // namespace
}  // namespace fleetmap
