#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using FuzzFleetCommand = testing::CommandLineTest;

TEST_F(FuzzFleetCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"fuzz-fleet", "--seeds", "0"}, "--seeds: must be a whole number of at least 1");
  expect_usage_error({"fuzz-fleet", "--robots", "1,3"}, "--robots: must be a whole number from 2 to 20");
  expect_usage_error({"fuzz-fleet", "--mapping", "0"}, "--mapping: must be a number greater than 0");
  expect_usage_error({"fuzz-fleet", "--jobs", "257"}, "--jobs: must be a whole number from 1 to 256");
  expect_usage_error({"fuzz-fleet", "--stores", ""}, "--stores: is empty; give a path");
}

}  // namespace
}  // namespace fleetmap
