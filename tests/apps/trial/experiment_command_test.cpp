#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ExperimentCommand = testing::CommandLineTest;

TEST_F(ExperimentCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"experiment", "--out", path("out")}, "--config is required");
  expect_usage_error({"experiment", "-c", "e", "--out", path("out"), "--jobs", "0"},
                     "--jobs: must be a whole number from 1 to 1024");
}

}  // namespace
}  // namespace fleetmap
