#include "document_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

std::optional<FileKind> kind(const char* text) { return kind_of(YAML::Load(text)); }

TEST(DocumentKind, IsShownByTheKeys) {
  EXPECT_EQ(kind("{id: r1}"), FileKind::kRobot);
  EXPECT_EQ(kind("{agents: []}"), FileKind::kFleet);
  EXPECT_EQ(kind("{kind: farm}"), FileKind::kWorld);
  EXPECT_EQ(kind("{studies: []}"), FileKind::kExperiment);
  for (const char* sensor : {"{elevations_deg: [1]}", "{pattern: spinning}", "{field_of_view_deg: 30}"})
    EXPECT_EQ(kind(sensor), FileKind::kSensor) << sensor;
}

TEST(DocumentKind, AFleetMayNameARobotsKeys) { EXPECT_EQ(kind("{id: r1, agents: []}"), FileKind::kFleet); }

TEST(DocumentKind, IsUnknownWhereNoKeyShowsIt) {
  for (const char* text : {"", "{}", "[agents, id]", "agents", "{lidar: {id: r1}}", "~"})
    EXPECT_EQ(kind(text), std::nullopt) << text;
}

TEST(DocumentKind, AnotherKindIsRefusedWithTheRemedy) {
  const Document fleet = Document::from(YAML::Load("{agents: []}"), "fleet.yaml");
  EXPECT_TRUE(expect_kind(fleet, {FileKind::kFleet}, "FLEET.yaml"));
  EXPECT_TRUE(expect_kind(fleet, {FileKind::kRobot, FileKind::kFleet}, "AGENT.yaml or FLEET.yaml"));
  const Status refused = expect_kind(fleet, {FileKind::kRobot}, "AGENT.yaml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "fleet.yaml: this is a fleet; give AGENT.yaml");
  EXPECT_TRUE(expect_kind(Document::from(YAML::Load("{}"), "any.yaml"), {FileKind::kRobot}, "AGENT.yaml"));
}

TEST(DocumentKind, FilesAreLoadedWithTheirOverrides) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("robot.yaml", "{id: r1, lidar: {model: vlp16}}\n");
  const auto loaded = load_with(file, {{"lidar.model", "os1-64"}});
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->root()["lidar"]["model"].as<std::string>(), "os1-64");
  EXPECT_FALSE(load_with(folder.path() / "none.yaml", {}));
  const auto damaged = load_with(folder.write("damaged.yaml", "{id: r1"), {});
  ASSERT_FALSE(damaged);
  EXPECT_THAT(damaged.error().message, HasSubstr("damaged.yaml"));
}

}  // namespace
}  // namespace fleetmap::config
