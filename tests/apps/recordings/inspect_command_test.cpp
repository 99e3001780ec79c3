#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using InspectCommand = testing::CommandLineTest;

TEST_F(InspectCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"inspect"}, "recording is required");
  expect_usage_error({"inspect", "bag", "--set", "lidar.model"}, "lidar.model");
}

}  // namespace
}  // namespace fleetmap
