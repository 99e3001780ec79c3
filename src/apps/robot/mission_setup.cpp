#include "mission_setup.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/planning/site/geojson.hpp"
#include "fleetmap/planning/site/row_selection.hpp"

namespace fleetmap::apps {
namespace {

planning::RobotAbility ability_of(const config::FleetConfig::Member& member,
                                  const planning::MissionConfig& mission) {
  planning::RobotAbility ability;
  ability.id = member.agent.id;
  ability.speed = std::min(mission.speed, member.robot.vehicle.max_speed);
  ability.yaw_rate = std::min(ability.yaw_rate, member.robot.vehicle.max_yaw_rate);
  ability.battery_wh = member.robot.vehicle.battery_wh;
  ability.power_idle_w = member.robot.vehicle.idle_power_w;
  ability.energy_per_metre_wh = member.robot.vehicle.energy_per_metre / 3600.0;
  return ability;
}

}  // namespace

std::vector<planning::RobotAbility> abilities_of(const config::FleetConfig& config) {
  std::vector<planning::RobotAbility> fleet;
  for (const auto& member : config.members) fleet.push_back(ability_of(member, config.twin->mission));
  return fleet;
}

planning::Mission mission_on(const sim::SiteDrawing& drawing) {
  planning::Mission site;
  for (const sim::Aisle& lane : drawing.lanes) {
    site.rows.push_back({static_cast<planning::RowId>(site.rows.size()), {lane.from, lane.to}});
  }
  site.keep_out = drawing.keep_out;
  site.boundary = drawing.boundary;
  if (!site.rows.empty()) site.starts.push_back({{}, site.rows.front().waypoints.front()});
  return site;
}

Result<std::shared_ptr<const planning::FleetPlan>> plan_on(planning::Mission site,
                                                           std::vector<planning::RobotAbility> fleet,
                                                           const planning::MissionConfig& settings) {
  planning::Mission mission = planning::with_selected_rows(std::move(site), settings.rows);
  if (const Status sound = mission.validate(); !sound) return tl::unexpected(sound.error());
  const planning::Polyline& first = mission.rows.front().waypoints;
  const Eigen::Vector2d ahead = first.back() - first.front();
  for (planning::RobotAbility& robot : fleet) {
    robot.start = {mission.start_of(robot.id), std::atan2(ahead.y(), ahead.x())};
  }
  return planning::plan_fleet(std::move(mission), fleet, settings);
}

Status plan_mission(config::RobotConfig& robot) {
  if (!robot.mission) return {};
  const config::RobotMission& mission = *robot.mission;
  auto site = planning::read_geojson(mission.settings.file, LocalFrame(*robot.agent.site_origin));
  if (!site) return tl::unexpected(site.error());
  auto plan = plan_on(std::move(*site), mission.fleet, mission.settings);
  if (!plan) return failure(mission.at + ": " + plan.error().message);
  agent::NavigatorConfig navigator;
  navigator.plan = *plan;
  navigator.follower.max_speed = (*plan)->fleet[*(*plan)->find(robot.agent.id)].speed;
  navigator.follower.robot_radius = mission.shape.radius;
  navigator.obstacles.base_height = mission.shape.base_height;
  if (const Status sound = navigator.follower.validate(); !sound)
    return failure(mission.at + ".robots." + robot.agent.id.str() + ": " + sound.error().message);
  robot.agent.navigator = std::make_shared<const agent::NavigatorConfig>(navigator);
  return {};
}

}  // namespace fleetmap::apps
