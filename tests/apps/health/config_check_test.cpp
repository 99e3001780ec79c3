#include <gmock/gmock.h>

#include <filesystem>

#include "apps/small_twin.hpp"
#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using ConfigCheck = testing::CommandLineTest;

TEST_F(ConfigCheck, BadConfigurationExitsWith78AndNamesFileAndLine) {
  folder_.write("bad.yaml", "id: r1\nfleet: [r1]\ndirectory: out\nlidar: {modle: vlp16}\n");
  for (const std::string command : {"check-config", "agent"}) {
    run(command == "agent" ? std::vector<std::string>{command, "-c", path("bad.yaml")}
                           : std::vector<std::string>{command, path("bad.yaml")});
    EXPECT_EQ(exit_code_, 78) << command;
    EXPECT_THAT(output_, HasSubstr("bad.yaml:4: lidar.modle: unknown key; did you mean 'model'?"));
  }
}

TEST_F(ConfigCheck, SaysWhatAFileIs) {
  const auto says = [&](const std::filesystem::path& file) {
    run({"check-config", file.string()});
    EXPECT_EQ(exit_code_, 0) << output_;
    return output_;
  };
  const testing::SmallTwin twin;
  EXPECT_THAT(says(twin.path("fleet.yaml")),
              HasSubstr("a valid fleet configuration of the twin: 3 robots, 3 rows"));
  EXPECT_THAT(says(twin.path("world.yaml")), HasSubstr("a valid world with 3 lanes"));
  EXPECT_THAT(says(twin.path("lidar.yaml")), HasSubstr("a valid sensor"));
  const std::filesystem::path shipped = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";
  EXPECT_THAT(says(shipped / "experiments/paper.yaml"), HasSubstr("a valid experiment with "));
  EXPECT_THAT(says(shipped / "experiments/accuracy.yaml"), HasSubstr("a valid experiment with "));
  EXPECT_THAT(says(shipped / "experiments/missions.yaml"), HasSubstr("a valid experiment with "));
  EXPECT_THAT(says(shipped / "agents/r1.yaml"), HasSubstr("a valid agent configuration"));
  EXPECT_THAT(says(shipped / "fleets/demo.yaml"), HasSubstr("3 robots, 3 rows"))
      << "on the drawing of its site";
  EXPECT_THAT(says(shipped / "fleets/farm_small.yaml"), HasSubstr("5 robots"));
  EXPECT_THAT(says(shipped / "robots/jackal_vlp16.yaml"), HasSubstr("a valid "));
  EXPECT_THAT(says(shipped / "fleets/kitti_0005.yaml"), HasSubstr("a valid fleet configuration"));
}

TEST_F(ConfigCheck, RadiosAreThoseOfOneRobot) {
  const testing::SmallTwin twin;
  expect_usage_error({"check-config", "--network", twin.path("fleet.yaml").string()},
                     "fleet.yaml: --network needs the file of one robot");
  expect_usage_error(
      {"check-config", "--network", "--domains", "5", "4", FLEETMAP_SOURCE_DIR "/config/agents/r1.yaml"},
      "--domains: the first must not be above the last");
}

}  // namespace
}  // namespace fleetmap
