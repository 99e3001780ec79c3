#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ReplayCommand = testing::CommandLineTest;

TEST_F(ReplayCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"replay", "x", "--rate", "0"}, "--rate: Value 0 not in range");
  expect_usage_error({"replay", "x", "--wait", "-1"}, "--wait: must be a number of at least 0");
  expect_usage_error({"replay"}, "name a recording, or give -c a file with recording.path");
}

}  // namespace
}  // namespace fleetmap
