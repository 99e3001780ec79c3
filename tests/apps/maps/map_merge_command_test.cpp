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

TEST_F(MapMergeCommand, HelpSaysThatTwoStoresOrMoreAreMerged) {
  run({"map", "merge", "--help"});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_NE(output_.find(" stores..."), std::string::npos) << output_;
  EXPECT_NE(output_.find("at least two"), std::string::npos) << output_;
  EXPECT_EQ(output_.find("2x"), std::string::npos) << output_;
}

}  // namespace
}  // namespace fleetmap
