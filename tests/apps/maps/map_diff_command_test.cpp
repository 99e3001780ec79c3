#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using MapDiffCommand = testing::CommandLineTest;

TEST_F(MapDiffCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"map", "diff", "a.db"}, "after is required");
  expect_usage_error({"map", "diff", "a.db", "b.db", "--ply", ""}, "--ply: is empty; give a path");
  expect_usage_error({"map", "diff", "a.db", "b.db", "--geojson", ""}, "--geojson: is empty; give a path");
}

}  // namespace
}  // namespace fleetmap
