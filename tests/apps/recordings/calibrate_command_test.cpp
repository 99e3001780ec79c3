#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using CalibrateCommand = testing::CommandLineTest;

TEST_F(CalibrateCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"calibrate"}, "recording is required");
  expect_usage_error({"calibrate", "bag", "--set", "lidar.model"}, "lidar.model");
}

}  // namespace
}  // namespace fleetmap
