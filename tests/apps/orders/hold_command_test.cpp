#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using HoldCommand = testing::CommandLineTest;

TEST_F(HoldCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"hold"}, "--config is required");
  expect_usage_error({"resume", "-c", "f", "--robot", ""}, "--robot: is empty; give a path");
  expect_usage_error({"home", "-c", "f", "--timeout", "0"}, "--timeout: must be a number greater than 0");
  expect_usage_error({"give", "-c", "f", "--row", "3"}, "--robot is required");
  expect_usage_error({"give", "-c", "f", "--robot", "r1"}, "--row is required");
  expect_usage_error({"give", "-c", "f", "--robot", "r1", "--row", "3", "--to", ""},
                     "--to: is empty; give a path");
}

}  // namespace
}  // namespace fleetmap
