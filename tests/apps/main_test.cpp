// `fleetmap` itself: its commands, and exit codes that scripts rely on.
#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using Main = testing::CommandLineTest;

TEST_F(Main, WithoutAKnownCommandItExitsWith2) {
  run({});
  EXPECT_EQ(exit_code_, 2);
  run({"fly"});
  EXPECT_EQ(exit_code_, 2);
  run({"keys", "--log", "loud"});
  EXPECT_EQ(exit_code_, 2);
}

TEST_F(Main, HelpExitsWith0AndNamesEveryCommand) {
  run({"--help"});
  EXPECT_EQ(exit_code_, 0);
  for (const char* command :
       {"run", "agent", "replay", "odometry", "register", "check-config", "map", "eval"}) {
    EXPECT_THAT(output_, HasSubstr(command));
  }
}

}  // namespace
}  // namespace fleetmap
