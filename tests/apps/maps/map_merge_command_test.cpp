#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using MapMergeCommand = testing::CommandLineTest;

TEST_F(MapMergeCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"map", "merge", "a.db", "--out", "m.db"}, "stores: At least 2 required but received 1");
  expect_usage_error({"map", "merge", "a.db", "b.db"}, "--out is required");
  expect_usage_error({"map", "merge", "a.db", "b.db", "--out", "m.db", "--keys", ""},
                     "--keys: is empty; give a path");
  folder_.write("a.db", "a store");
  expect_usage_error({"map", "merge", path("a.db"), path("./a.db"), "--out", path("m.db")}, "is named twice");
}

}  // namespace
}  // namespace fleetmap
