#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using EvalCommand = testing::CommandLineTest;

TEST_F(EvalCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"eval"}, "directory is required");
  expect_usage_error({"eval", "run", "--modes", "best"}, "--modes: best not in {");
  expect_usage_error({"eval", "run", "--max-map-points", "0"}, "--max-map-points: ");
}

}  // namespace
}  // namespace fleetmap
