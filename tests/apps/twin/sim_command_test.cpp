#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using SimCommand = testing::CommandLineTest;

TEST_F(SimCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"sim"}, "--config is required");
  expect_usage_error({"sim", "-c", "f", "--duration", "-1"},
                     "--duration: must be a number of at least 0, is -1\n");
  expect_usage_error({"sim", "-c", "f", "--out", ""}, "--out: is empty; give a path");
}

}  // namespace
}  // namespace fleetmap
