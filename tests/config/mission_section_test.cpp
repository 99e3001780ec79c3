#include "mission_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

struct Reading {
  planning::MissionConfig mission;
  std::string problems;
};

Reading read(const std::string& yaml, const std::string& name = "fleet.yaml") {
  Document document = Document::from(YAML::Load(yaml), name);
  Section top(document, document.root(), "");
  Reading reading;
  read_mission(top, reading.mission);
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(MissionSection, WithoutItTheDefaultsHold) {
  const Reading reading = read("other: 1");
  EXPECT_EQ(reading.problems, "");
  EXPECT_EQ(reading.mission.waypoints, "aisles");
  EXPECT_EQ(reading.mission.division.method, planning::DivisionMethod::kBalanced);
}

TEST(MissionSection, EveryKeyIsRead) {
  const Reading reading = read(
      "mission: {waypoints: aisles, every: 3, max_row_length: 50, division: energy, rendezvous: false, "
      "speed: 1.2,"
      " clearance: 0.9, battery_reserve: 0.3, c_max: 60, map_bytes_per_metre: 1000, lost_after: 30,"
      " low_battery: 0.1, meeting_timeout: 99}");
  EXPECT_EQ(reading.problems, "");
  EXPECT_EQ(reading.mission.lanes.every, 3);
  EXPECT_EQ(reading.mission.lanes.max_row_length, 50.0);
  EXPECT_EQ(reading.mission.division.method, planning::DivisionMethod::kEnergy);
  EXPECT_FALSE(reading.mission.rendezvous);
  EXPECT_EQ(reading.mission.speed, 1.2);
  EXPECT_EQ(reading.mission.routes.clearance, 0.9);
  EXPECT_EQ(reading.mission.division.battery_reserve, 0.3);
  EXPECT_EQ(reading.mission.meeting.c_max, 60.0);
  EXPECT_EQ(reading.mission.meeting.map_bytes_per_metre, 1000.0);
  EXPECT_EQ(reading.mission.executive.lost_after, 30.0);
  EXPECT_EQ(reading.mission.executive.low_battery, 0.1);
  EXPECT_EQ(reading.mission.executive.meeting_timeout, 99.0);
}

TEST(MissionSection, ProblemsNameLineKeyAndRule) {
  EXPECT_THAT(read("a: 1\nmission:\n  division: fair\n").problems,
              HasSubstr("fleet.yaml:3: mission.division"));
  EXPECT_THAT(read("mission: {evry: 2}").problems, HasSubstr("every"));
  EXPECT_THAT(read("mission: {every: 0}").problems, HasSubstr("every: must be at least 1"));
  EXPECT_THAT(read("mission: {low_battery: 2}").problems, HasSubstr("low_battery"));
  EXPECT_THAT(read("mission: {waypoints: none.geojson}").problems, HasSubstr("no such file"));
}

TEST(MissionSection, WaypointsAreRelativeToTheFile) {
  testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "rows.geojson") << "{}";
  const Reading reading = read("mission: {waypoints: rows.geojson}", (folder.path() / "fleet.yaml").string());
  EXPECT_EQ(reading.problems, "");
  EXPECT_EQ(reading.mission.waypoints, (folder.path() / "rows.geojson").string());
}

}  // namespace
}  // namespace fleetmap::config
