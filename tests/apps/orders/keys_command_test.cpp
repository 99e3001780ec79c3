#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using KeysCommand = testing::CommandLineTest;

TEST_F(KeysCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"keys"}, "A subcommand is required");
  expect_usage_error({"keys", "init"}, "--dir is required");
  expect_usage_error({"keys", "init", "--dir", ""}, "--dir: is empty; give a path");
  expect_usage_error({"keys", "add", "--dir", path("keys")}, "name is required");
  expect_usage_error({"keys", "add", "r1", "--dir", path("keys"), "--role", "spy"}, "--role: spy not in {");
  expect_usage_error({"keys", "add", "r1", "--dir", path("keys"), "--days", "7301"},
                     "--days: must be a whole number from 1 to 7300");
}

}  // namespace
}  // namespace fleetmap
