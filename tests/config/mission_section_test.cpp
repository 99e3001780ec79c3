#include "mission_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct MissionReading {
  TwinConfig twin;
  std::optional<RobotMission> robot;
  std::string problems;
};

MissionReading mission_of(const std::string& yaml, const std::string& name = "fleet.yaml") {
  Document document = Document::from(YAML::Load(yaml), name);
  Section top(document, document.root(), "");
  MissionReading reading;
  read_mission(top, reading.twin);
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

/// As the robot r1 of three reads it.
MissionReading read_robot(const std::string& yaml, const std::string& name, bool origin = true) {
  Document document = Document::from(YAML::Load(yaml), name);
  Section top(document, document.root(), "");
  agent::AgentConfig agent;
  agent.id = *AgentId::parse("r1");
  for (const char* id : {"r1", "r2", "r3"}) agent.exchange.fleet.push_back(*AgentId::parse(id));
  if (origin) agent.site_origin = geo_point_from_degrees(39.0, -3.0, 600.0);
  MissionReading reading;
  reading.robot = read_mission(top, agent);
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(MissionSection, WithoutItTheDefaultsHold) {
  const MissionReading reading = mission_of("other: 1");
  EXPECT_EQ(reading.problems, "");
  EXPECT_TRUE(reading.twin.mission.file.empty());
  EXPECT_EQ(reading.twin.mission.division.method, planning::DivisionMethod::kBalanced);
  EXPECT_EQ(reading.twin.map_error, 0.5);
  EXPECT_EQ(reading.twin.unknown_obstacles, 0u);
  EXPECT_FALSE(read_robot("other: 1", "r1.yaml").robot);
}

TEST(MissionSection, EveryKeyIsRead) {
  const MissionReading reading = mission_of(
      "mission: {every: 3, max_row_length: 50, division: energy, rendezvous: false, speed: 1.2,"
      " clearance: 0.9, battery_reserve: 0.3, c_max: 60, map_bytes_per_metre: 1000, lost_after: 30,"
      " low_battery: 0.1, meeting_timeout: 99, map_error_m: 2, unknown_obstacles: 4}");
  EXPECT_EQ(reading.problems, "");
  const planning::MissionConfig& mission = reading.twin.mission;
  EXPECT_EQ(mission.rows.every, 3);
  EXPECT_EQ(mission.rows.max_row_length, 50.0);
  EXPECT_EQ(mission.division.method, planning::DivisionMethod::kEnergy);
  EXPECT_FALSE(mission.rendezvous);
  EXPECT_EQ(mission.speed, 1.2);
  EXPECT_EQ(mission.routes.clearance, 0.9);
  EXPECT_EQ(mission.division.battery_reserve, 0.3);
  EXPECT_EQ(mission.meeting.c_max, 60.0);
  EXPECT_EQ(mission.meeting.map_bytes_per_metre, 1000.0);
  EXPECT_EQ(mission.executive.lost_after, 30.0);
  EXPECT_EQ(mission.executive.low_battery, 0.1);
  EXPECT_EQ(mission.executive.meeting_timeout, 99.0);
  EXPECT_EQ(reading.twin.map_error, 2.0);
  EXPECT_EQ(reading.twin.unknown_obstacles, 4u);
}

TEST(MissionSection, ARobotsOwnFileGivesTheAbilitiesOfAll) {
  testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "site.geojson") << "{}";
  const std::string name = (folder.path() / "r1.yaml").string();
  const MissionReading reading = read_robot(
      "mission: {file: site.geojson, speed: 1.4, every: 2, robots: {r1: {radius: 0.4, base_height: 0.2}, "
      "r2: {max_speed: 0.9, battery_wh: 100, energy_per_metre: 36}, r3: {max_speed: 3}}}",
      name);
  ASSERT_EQ(reading.problems, "");
  ASSERT_TRUE(reading.robot);
  EXPECT_EQ(reading.robot->settings.file, folder.path() / "site.geojson");
  EXPECT_EQ(reading.robot->settings.rows.every, 2);
  ASSERT_EQ(reading.robot->fleet.size(), 3u);
  EXPECT_EQ(reading.robot->fleet[0].speed, 1.4);
  EXPECT_EQ(reading.robot->fleet[1].speed, 0.9);
  EXPECT_EQ(reading.robot->fleet[1].battery_wh, 100.0);
  EXPECT_NEAR(reading.robot->fleet[1].energy_per_metre_wh, 0.01, 1e-12);
  EXPECT_EQ(reading.robot->fleet[2].speed, 1.4) << "mission.speed is the most";
  EXPECT_EQ(reading.robot->shape.radius, 0.4);
  EXPECT_EQ(reading.robot->shape.base_height, 0.2);

  const auto problems = [&](const std::string& mission, bool origin = true) {
    return read_robot("mission: {" + mission + "}", name, origin).problems;
  };
  EXPECT_THAT(problems("speed: 1"), HasSubstr("mission.file: expected the GeoJSON drawing of the site"));
  EXPECT_THAT(problems("file: none.geojson"), HasSubstr("none.geojson: no such file"));
  EXPECT_THAT(problems("file: site.geojson", false), HasSubstr("needs site: {origin:"));
  EXPECT_THAT(problems("file: site.geojson, unknown_obstacles: 3"), HasSubstr("is for the twin"));
  EXPECT_THAT(problems("file: site.geojson, robots: {r9: {max_speed: 1}}"), HasSubstr("mission.robots.r9"));
  EXPECT_THAT(problems("file: site.geojson, robots: {r2: {battery_wh: -1}}"), HasSubstr("battery_wh"));
  EXPECT_THAT(problems("file: site.geojson, robots: {r1: {radius: 0}}"),
              HasSubstr("mission.robots.r1.radius"));
}

TEST(MissionSection, ProblemsNameLineKeyAndRule) {
  EXPECT_THAT(mission_of("a: 1\nmission:\n  division: fair\n").problems,
              HasSubstr("fleet.yaml:3: mission.division"));
  EXPECT_THAT(mission_of("mission: {evry: 2}").problems, HasSubstr("every"));
  EXPECT_THAT(mission_of("mission: {every: 0}").problems, HasSubstr("every: must be at least 1"));
  EXPECT_THAT(mission_of("mission: {low_battery: 2}").problems, HasSubstr("low_battery"));
  EXPECT_THAT(mission_of("mission: {file: none.geojson}").problems, HasSubstr("no such file"));
  EXPECT_THAT(mission_of("mission: {waypoints: rows.geojson}").problems,
              HasSubstr("mission.waypoints: is not a key any more; name the site's drawing with file"));
  EXPECT_THAT(mission_of("mission: {map_error_m: -1}").problems,
              HasSubstr("mission.map_error_m: expected m"));
}

TEST(MissionSection, TheDrawingIsRelativeToTheFile) {
  testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "rows.geojson") << "{}";
  const std::string name = (folder.path() / "fleet.yaml").string();
  const MissionReading reading = mission_of("mission: {file: rows.geojson}", name);
  EXPECT_EQ(reading.problems, "");
  EXPECT_EQ(reading.twin.mission.file, folder.path() / "rows.geojson");
  EXPECT_THAT(mission_of("mission: {file: rows.geojson, map_error_m: 1}", name).problems,
              HasSubstr("is for the drawing that the twin makes"));
}

}  // namespace
}  // namespace fleetmap::config
