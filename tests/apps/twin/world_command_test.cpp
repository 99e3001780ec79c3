#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using WorldCommand = testing::CommandLineTest;

TEST_F(WorldCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"world"}, "file is required");
  expect_usage_error({"world", "w", "--seed", "-1"}, "--seed: must be a whole number of at least 0, is -1");
  expect_usage_error({"world", "w", "--seed", "010"}, "--seed: must be a whole number");
  expect_usage_error({"world", "w", "--density", "0"}, "--density: must be a number greater than 0, is 0\n");
  expect_usage_error({"world", "w", "--density", "nan"}, "--density: must be a number greater than 0");
  expect_usage_error({"world", "w", "--max-points", "0"},
                     "--max-points: must be a whole number from 1 to 200000000");
  expect_usage_error({"world", "w", "--map-error", "-1"}, "--map-error: must be a number of at least 0");
  expect_usage_error({"world", "w", "--out", ""}, "--out: is empty; give a path");
}

}  // namespace
}  // namespace fleetmap
