#include "health/config_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A file of config/, or the error.
std::string description(const std::string& file, const std::vector<config::Override>& overrides = {},
                        const std::optional<std::size_t>& agents = std::nullopt) {
  const auto text = describe_config(FLEETMAP_SOURCE_DIR "/config/" + file, overrides, agents);
  return text ? *text : "error: " + text.error().message;
}

TEST(ConfigDescription, NamesTheKindOfEachFile) {
  EXPECT_EQ(description("sensors/vlp16.yaml"), "a valid sensor");
  EXPECT_EQ(description("agents/r1.yaml"), "a valid agent configuration");
  EXPECT_EQ(description("fleets/kitti_0005.yaml"), "a valid fleet configuration");
  EXPECT_THAT(description("worlds/farm_44.yaml"), StartsWith("a valid world with "));
  EXPECT_THAT(description("experiments/paper.yaml"), StartsWith("a valid experiment with "));
}

TEST(ConfigDescription, AFleetOfTheTwinIsPlannedWithTheRobotsThatAreKept) {
  EXPECT_THAT(description("fleets/farm_small.yaml", {}, 2),
              AllOf(StartsWith("a valid fleet configuration of the twin: 2 robots, "),
                    HasSubstr("planned to be driven in ")));
  EXPECT_THAT(description("fleets/farm_small.yaml", {}, 99), HasSubstr("twin: 5 robots, "))
      << "no more than there are";
}

TEST(ConfigDescription, AnAgentsMissionIsPlanned) {
  EXPECT_THAT(
      description("agents/r1.yaml", {{"site.origin", "[39.0, -3.0, 600.0]"},
                                     {"mission.file", FLEETMAP_SOURCE_DIR "/config/sites/farm_200.geojson"}}),
      StartsWith("a valid agent configuration with a mission: 2 robots, "));
}

TEST(ConfigDescription, FailsWithFileAndLine) {
  EXPECT_THAT(description("worlds/none.yaml"), HasSubstr("none.yaml"));
  EXPECT_THAT(description("fleets/farm_small.yaml", {{"defaults.nodes.spacing", "-1"}}),
              StartsWith("error: "));
  const testing::TemporaryFolder folder;
  const auto bad = describe_config(
      folder.write("fleet.yaml", "id: r1\nfleet: [r1]\nlidar: {modell: x}\n").string(), {}, std::nullopt);
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("fleet.yaml:3: "));
}

}  // namespace
}  // namespace fleetmap::apps
