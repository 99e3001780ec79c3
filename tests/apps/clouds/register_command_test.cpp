#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using RegisterCommand = testing::CommandLineTest;

TEST_F(RegisterCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"register", "a.ply"}, "target is required");
  expect_usage_error({"register", "a.ply", "b.ply", "--prior", "1,2,3"},
                     "--prior: At least 4 required but received 3");
  expect_usage_error({"register", "a.ply", "b.ply", "--sigma", "1,2"}, "--sigma requires --prior");
}

}  // namespace
}  // namespace fleetmap
