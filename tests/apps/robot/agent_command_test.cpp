#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using AgentCommand = testing::CommandLineTest;

TEST_F(AgentCommand, RefusesWhatItCannotTake) {
  expect_usage_error({"agent"}, "--config is required");
  expect_usage_error({"agent", "-c", "r1.yaml", "--out", path("out")}, "--out requires --as");
  expect_usage_error({"agent", "-c", "f", "--as", "r1", "--out", ""}, "--out: is empty; give a path");
  expect_usage_error({"agent", "-c", "f", "--exit-after-idle", "-3"},
                     "--exit-after-idle: must be a number of at least 0");
}

TEST_F(AgentCommand, MissingProfilesStopItBeforeItDrives) {
  folder_.write("r1.yaml", "id: r1\nfleet: [r1]\ndirectory: out\ndds: {qos: no_such_folder}\n");
  run({"agent", "-c", path("r1.yaml")});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("no_such_folder"));
}

}  // namespace
}  // namespace fleetmap
