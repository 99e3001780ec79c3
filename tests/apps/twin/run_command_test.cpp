#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using RunCommand = testing::CommandLineTest;

TEST_F(RunCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"run", "-c", "f", "--out", path("out"), "--agents", "0"},
                     "--agents: must be a whole number of at least 1");
  expect_usage_error({"run", "-c", "f", "--out", path("out"), "--agents", "-1"},
                     "--agents: must be a whole number of at least 1");
  expect_usage_error({"run", "-c", "f", "--out", path("out"), "--threads", "-1"},
                     "--threads: must be a whole number from 1 to 256");
  expect_usage_error({"run", "-c", "f", "--out", path("out"), "--first-session", "60001"},
                     "--first-session: must be a whole number from 0 to 60000");
  expect_usage_error({"run", "-c", "f", "--out", ""}, "--out: is empty; give a path");
  expect_usage_error({"run", "-c", "f"}, "--out is required");
}

}  // namespace
}  // namespace fleetmap
