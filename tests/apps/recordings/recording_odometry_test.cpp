#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using RecordingOdometry = testing::CommandLineTest;

TEST_F(RecordingOdometry, AMissingRecordingIsNamed) {
  run({"odometry", path("nothing"), "--out", path("o.tum")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr(path("nothing")));
}

TEST_F(RecordingOdometry, AFolderThatIsMissingIsNamedBeforeAnythingIsRead) {
  run({"odometry", path("nothing"), "--out", path("none/o.tum")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr(path("none") + ": is no folder"));
}

}  // namespace
}  // namespace fleetmap
