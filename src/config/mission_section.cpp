#include "mission_section.hpp"

#include <filesystem>
#include <string>

namespace fleetmap::config {
namespace {

void read_waypoints(Section& section, std::string& waypoints) {
  section.read("waypoints", waypoints);
  if (!section.has("waypoints") || waypoints == "aisles") return;
  std::filesystem::path file;
  section.read_path("waypoints", file);
  if (const auto reason = unreadable(file)) {
    section.problem("waypoints", file.string() + ": " + *reason +
                                     "; expected aisles (the world's lanes) or the path of a GeoJSON file");
  }
  waypoints = file.string();
}

}  // namespace

void read_mission(Section& top, planning::MissionConfig& mission) {
  Section section = top.section("mission");
  read_waypoints(section, mission.waypoints);
  section.read("every", mission.lanes.every);
  section.read("max_row_length", mission.lanes.max_row_length);
  std::string method = planning::to_string(mission.division.method);
  section.read("division", method);
  if (const auto known = planning::division_method(method)) {
    mission.division.method = *known;
  } else {
    section.problem("division", known.error().message);
  }
  section.read("rendezvous", mission.rendezvous);
  section.read("speed", mission.speed);
  section.read("clearance", mission.routes.clearance);
  section.read("battery_reserve", mission.division.battery_reserve);
  section.read("c_max", mission.meeting.c_max);
  section.read("map_bytes_per_metre", mission.meeting.map_bytes_per_metre);
  section.read("least_gain", mission.meeting.least_gain);
  section.read("lost_after", mission.executive.lost_after);
  section.read("low_battery", mission.executive.low_battery);
  section.read("meeting_timeout", mission.executive.meeting_timeout);
  section.read("stop_patience", mission.executive.stop_patience);
  section.finish();
  section.check(mission.validate());
}

}  // namespace fleetmap::config
