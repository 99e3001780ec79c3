#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using TrialCommand = testing::CommandLineTest;

TEST_F(TrialCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"trial", "--out", path("out")}, "file is required");
  expect_usage_error({"trial", "t.yaml", "--out", path("out"), "--traces", path("none.csv")},
                     "--traces: File does not exist: ");
}

}  // namespace
}  // namespace fleetmap
