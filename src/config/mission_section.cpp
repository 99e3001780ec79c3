#include "mission_section.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

namespace fleetmap::config {
namespace {

void read_file(Section& section, std::filesystem::path& file) {
  section.read_path("file", file);
  if (section.has("waypoints")) {
    section.problem(
        "waypoints",
        "is not a key any more; name the site's drawing with file: SITE.geojson, or leave it out in a "
        "fleet of the twin, which then plans on a drawing of its world");
  }
  if (!section.has("file")) return;
  if (const auto reason = unreadable(file)) {
    section.problem("file", file.string() + ": " + *reason +
                                "; expected the GeoJSON drawing of the site, e.g. of `fleetmap world`");
  }
}

/// The keys that a fleet of the twin and a robot have in common.
void read_settings(Section& section, planning::MissionConfig& mission) {
  read_file(section, mission.file);
  section.read("every", mission.rows.every);
  section.read("max_row_length", mission.rows.max_row_length);
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
  section.read("min_gain", mission.meeting.min_gain);
  section.read("lost_after", mission.executive.lost_after);
  section.read("low_battery", mission.executive.low_battery);
  section.read("meeting_timeout", mission.executive.meeting_timeout);
  section.read("stop_patience", mission.executive.stop_patience);
}

void read_ability(Section& section, planning::RobotAbility& ability, RobotShape* shape) {
  section.read("max_speed", ability.speed);
  section.read("max_yaw_rate", ability.yaw_rate);
  section.read("battery_wh", ability.battery_wh);
  section.read("idle_power_w", ability.power_idle_w);
  double joules = ability.energy_per_metre_wh * 3600.0;
  section.read("energy_per_metre", joules);
  ability.energy_per_metre_wh = joules / 3600.0;
  RobotShape ignored;
  RobotShape& own = shape ? *shape : ignored;
  section.read("radius", own.radius);
  section.read("base_height", own.base_height);
  section.finish();
  section.check(ability.validate());
  if (!(own.radius > 0.0 && own.radius <= 2.0)) section.problem("radius", "expected m within (0, 2]");
  if (!(own.base_height >= 0.0 && own.base_height <= 3.0))
    section.problem("base_height", "expected m from 0 to 3");
}

}  // namespace

void read_mission(Section& top, TwinConfig& twin) {
  Section section = top.section("mission");
  read_settings(section, twin.mission);
  section.read("map_error_m", twin.map_error);
  section.read("unknown_obstacles", twin.unknown_obstacles);
  section.finish();
  section.check(twin.mission.validate());
  if (!(twin.map_error >= 0.0 && twin.map_error <= 20.0))
    section.problem("map_error_m", "expected m from 0 to 20");
  if (!twin.mission.file.empty() && section.has("map_error_m"))
    section.problem("map_error_m",
                    "is for the drawing that the twin makes of its world, and file names another");
  if (twin.unknown_obstacles > 1000) section.problem("unknown_obstacles", "expected at most 1000");
}

void read_mission_settings(Section& top, planning::MissionConfig& mission) {
  Section section = top.section("mission");
  read_settings(section, mission);
  section.finish();
  section.check(mission.validate());
}

std::optional<RobotMission> read_mission(Section& top, const agent::AgentConfig& agent) {
  if (!top.has("mission")) return std::nullopt;
  RobotMission mission;
  mission.at = top.place("mission");
  Section section = top.section("mission");
  read_settings(section, mission.settings);
  for (const char* key : {"map_error_m", "unknown_obstacles"}) {
    if (section.has(key)) section.problem(key, "is for the twin, in a fleet's file");
  }
  Section robots = section.section("robots");
  for (const AgentId& id : agent.exchange.fleet) {
    planning::RobotAbility& ability = mission.fleet.emplace_back();
    ability.id = id;
    ability.speed = mission.settings.speed;
    Section robot = robots.section(id.str());
    read_ability(robot, ability, id == agent.id ? &mission.shape : nullptr);
    ability.speed = std::min(ability.speed, mission.settings.speed);
  }
  robots.finish();
  section.finish();
  section.check(mission.settings.validate());
  if (mission.settings.file.empty() && !section.has("file"))
    section.problem("file", "expected the GeoJSON drawing of the site: rows, keep-outs, boundary");
  if (!agent.site_origin)
    section.problem(
        "file", "needs site: {origin: [latitude_deg, longitude_deg, altitude_m]}, the same on every robot");
  return mission;
}

}  // namespace fleetmap::config
