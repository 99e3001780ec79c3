#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using TwinProcess = testing::CommandLineTest;

TEST_F(TwinProcess, OutThatCannotBeWrittenStopsItAtOnce) {
  folder_.write("file", "no folder");
  run({"sim", "-c", std::string(FLEETMAP_SOURCE_DIR) + "/config/fleets/demo.yaml", "--out",
       path("file/out")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("file/out: cannot be made"));
}

TEST_F(TwinProcess, AFleetWithoutAWorldExitsWith78) {
  run({"sim", "-c", FLEETMAP_SOURCE_DIR "/config/fleets/kitti_0005.yaml"});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("kitti_0005.yaml: has no twin; expected world: {file: WORLD.yaml}"));
}

}  // namespace
}  // namespace fleetmap
