#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using OdometryCommand = testing::CommandLineTest;

TEST_F(OdometryCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"odometry", "bag"}, "--out is required");
  expect_usage_error({"odometry", "--out", path("o.tum")}, "recording is required");
  expect_usage_error({"odometry", "bag", "--out", ""}, "--out: is empty; give a path");
}

}  // namespace
}  // namespace fleetmap
