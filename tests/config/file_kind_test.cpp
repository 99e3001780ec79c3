#include "fleetmap/config/file_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config_files.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kConfig = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";

class FileKindTest : public ConfigFiles {
 protected:
  std::string error_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    const auto kind = check(write(text), overrides);
    return kind ? "no error" : kind.error().message;
  }
};

TEST_F(FileKindTest, IsThatOfTheLoadedFile) {
  EXPECT_EQ(check(kConfig / "agents" / "r1.yaml", {}).value(), FileKind::kRobot);
  EXPECT_EQ(check(kConfig / "fleets" / "demo.yaml", {}).value(), FileKind::kFleet);
  EXPECT_EQ(check(kConfig / "worlds" / "farm_60.yaml", {}).value(), FileKind::kWorld);
  EXPECT_EQ(check(kConfig / "sensors" / "vlp16.yaml", {}).value(), FileKind::kSensor);
  EXPECT_EQ(check(kConfig / "experiments" / "accuracy.yaml", {}).value(), FileKind::kExperiment);
}

TEST_F(FileKindTest, EachKindIsReadByItsOwnReader) {
  EXPECT_THAT(error_of("agents: [{id: a}]\n"), HasSubstr("agents[0].recording: expected"));
  EXPECT_THAT(error_of("studies: []\n"), HasSubstr("base: expected the FLEET.yaml"));
  EXPECT_THAT(error_of("kind: moon\n"), HasSubstr("moon"));
  EXPECT_THAT(error_of("pattern: spiral\n"), HasSubstr("spiral"));
  EXPECT_THAT(error_of("id: r1\n"), HasSubstr("directory: expected"));
  EXPECT_THAT(error_of("lidar: {}\n"), HasSubstr("id: expected the robot's name")) << "a robot's, or none";
}

TEST_F(FileKindTest, OverridesAreForRobotsAndFleets) {
  EXPECT_TRUE(check(write(kRobot), {{"lidar.model", "os1-64"}}));
  EXPECT_THAT(error_of(kRobot, {{"lidar.model", "none"}}), HasSubstr("--set lidar.model"));
  for (const std::string text : {"kind: solar_farm\n", "pattern: spinning\n", "studies: []\n"}) {
    EXPECT_THAT(error_of(text, {{"a", "1"}}),
                HasSubstr("config.yaml: --set changes keys of AGENT.yaml and FLEET.yaml only"))
        << text;
  }
}

TEST_F(FileKindTest, MissingFileIsNamed) {
  const auto kind = check(folder_.path() / "none.yaml", {});
  ASSERT_FALSE(kind);
  EXPECT_THAT(kind.error().message, HasSubstr("none.yaml: no such file"));
}

}  // namespace
}  // namespace fleetmap::config
