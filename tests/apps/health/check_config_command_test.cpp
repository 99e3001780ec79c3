#include <gtest/gtest.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using CheckConfigCommand = testing::CommandLineTest;

TEST_F(CheckConfigCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"check-config"}, "file is required");
  expect_usage_error({"check-config", "f", "--agents", "0"},
                     "--agents: must be a whole number of at least 1");
  expect_usage_error({"check-config", "f", "--seconds", "3"}, "--seconds requires --network");
  expect_usage_error({"check-config", "f", "--domains", "1", "2"}, "--domains requires --network");
  expect_usage_error({"check-config", "f", "--network", "--domains", "1", "231"},
                     "--domains: Value 231 not in range");
  expect_usage_error({"check-config", "f", "--network", "--seconds", "0"},
                     "--seconds: must be a number greater than 0");
}

}  // namespace
}  // namespace fleetmap
