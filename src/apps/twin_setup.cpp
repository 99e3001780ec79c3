#include "twin_setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/config/world_config.hpp"
#include "fleetmap/planning/geojson.hpp"
#include "fleetmap/sim/robot_twin.hpp"

namespace fleetmap::apps {
namespace {

/// Where sites are that name no origin.
const GeoPoint kSomewhere = geo_point_from_degrees(39.0, -3.0, 600.0);
constexpr double kStartSpacing = 2.5;    // m between robots that set out
constexpr double kStartSearch = 60.0;    // m around the first waypoint
constexpr double kStartClearance = 1.0;  // m, of free ground around a start

Result<planning::Mission> mission_of(const config::TwinConfig& twin, const sim::World& world,
                                     const GeoPoint& origin) {
  if (twin.mission.waypoints == "aisles" && world.aisles().empty()) {
    return failure(twin.world.string() +
                   ": the world has no aisles; name them there (aisles: [[[x, y], [x, y]]]) or give "
                   "mission.waypoints a GeoJSON file");
  }
  planning::SitePlan site;
  for (const sim::Aisle& aisle : world.aisles()) site.lanes.push_back({aisle.from, aisle.to});
  site.keep_out = world.plan();
  site.bounds = {world.bounds().low, world.bounds().high};
  return planning::make_mission(twin.mission, site, LocalFrame(origin));
}

/// Free places near `near`, the nearest first, apart from each other and from `taken`.
std::vector<Eigen::Vector2d> free_places(const sim::World& world, const Eigen::Vector2d& near,
                                         std::size_t count, std::vector<Eigen::Vector2d> taken) {
  std::vector<Eigen::Vector2d> candidates;
  const int reach = static_cast<int>(kStartSearch / kStartSpacing);
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) candidates.push_back(near + kStartSpacing * Eigen::Vector2d(x, y));
  }
  std::ranges::stable_sort(candidates, {}, [&](const auto& p) { return (p - near).squaredNorm(); });
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Vector2d& p : candidates) {
    if (places.size() == count) break;
    const bool apart =
        std::ranges::all_of(taken, [&](const auto& q) { return (p - q).norm() > 0.9 * kStartSpacing; });
    if (!apart || world.blocked(p, kStartClearance)) continue;
    places.push_back(p);
    taken.push_back(p);
  }
  return places;
}

Status choose_starts(config::FleetConfig& config, const sim::World& world, const planning::Mission& mission) {
  std::vector<Eigen::Vector2d> taken;
  std::size_t open = 0;
  for (const auto& member : config.members) {
    if (member.robot.start_given) taken.push_back(member.robot.start);
    open += !member.robot.start_given;
  }
  const Eigen::Vector2d first = mission.rows.front().waypoints.front();
  const Eigen::Vector2d ahead = mission.rows.front().waypoints.back() - first;
  const auto places = free_places(world, first, open, taken);
  if (places.size() < open) {
    return failure(config.twin->world.string() + ": no free ground for " + std::to_string(open) +
                   " robots near the first waypoint; give each agent robot.start: [east, north, yaw_deg]");
  }
  auto place = places.begin();
  for (auto& member : config.members) {
    if (member.robot.start_given) continue;
    member.robot.start_given = true;
    member.robot.start = *place++;
    member.robot.start_yaw = std::atan2(ahead.y(), ahead.x());
  }
  return {};
}

/// Every robot stands on free ground, and none in another one.
Status check_starts(const config::FleetConfig& config, const std::shared_ptr<const sim::World>& world,
                    const GeoPoint& origin) {
  for (const auto& member : config.members) {
    const auto twin = sim::RobotTwin::create(world, origin, member.robot, Stamp{});
    if (!twin) return failure(member.robot_at + "." + twin.error().message);
    for (const auto& other : config.members) {
      if (&other == &member) break;
      const double apart = (member.robot.start - other.robot.start).norm();
      const double needed = member.robot.vehicle.radius + other.robot.vehicle.radius;
      if (apart >= needed) continue;
      char text[160];
      std::snprintf(text, sizeof text,
                    ".start: is %.2f m from that of %s, and %.2f m are needed; move it, or leave start out",
                    apart, other.agent.id.str().c_str(), needed);
      return failure(member.robot_at + text);
    }
  }
  return {};
}

/// Scans come often enough that the drive guard lets a robot drive between two of them.
Status check_scan_rates(const config::FleetConfig& config) {
  const double longest = to_seconds(agent::DriveGuardConfig{}.patience);
  for (const auto& member : config.members) {
    if (1.0 / member.robot.lidar.rate < longest) continue;
    char text[160];
    std::snprintf(
        text, sizeof text,
        ".lidar_rate: a robot that drives a mission stands %.2f s after its last scan; set at least 5 Hz",
        longest);
    return failure(member.robot_at + text);
  }
  return {};
}

planning::RobotAbility ability_of(const config::FleetConfig::Member& member,
                                  const planning::MissionConfig& mission) {
  planning::RobotAbility ability;
  ability.id = member.agent.id;
  ability.start = {member.robot.start, member.robot.start_yaw};
  ability.speed = std::min(mission.speed, member.robot.vehicle.max_speed);
  ability.yaw_rate = std::min(ability.yaw_rate, member.robot.vehicle.max_yaw_rate);
  ability.battery_wh = member.robot.vehicle.battery_wh;
  ability.power_idle_w = member.robot.vehicle.idle_power_w;
  ability.energy_per_metre_wh = member.robot.vehicle.energy_per_metre / 3600.0;
  return ability;
}

}  // namespace

Result<TwinSetup> set_up_twin(config::FleetConfig& config) {
  const config::TwinConfig& twin = *config.twin;
  auto world = config::make_world(twin.world, twin.seed);
  if (!world) return tl::unexpected(world.error());
  TwinSetup setup;
  setup.world = *world;
  setup.origin = config.members.front().agent.site_origin.value_or(kSomewhere);
  const auto mission = mission_of(twin, *setup.world, setup.origin);
  if (!mission) return tl::unexpected(mission.error());
  if (const Status started = choose_starts(config, *setup.world, *mission); !started)
    return tl::unexpected(started.error());
  if (const Status free = check_starts(config, setup.world, setup.origin); !free)
    return tl::unexpected(free.error());
  if (const Status driven = check_scan_rates(config); !driven) return tl::unexpected(driven.error());
  std::vector<planning::RobotAbility> fleet;
  for (const auto& member : config.members) fleet.push_back(ability_of(member, twin.mission));
  auto plan = planning::plan_fleet(*mission, fleet, twin.mission);
  if (!plan) return failure(twin.mission_at + ": " + plan.error().message);
  setup.plan = *plan;
  std::uint64_t index = 0;
  for (auto& member : config.members) {
    member.agent.site_origin = setup.origin;
    // Another seed of the run gives every robot other errors, and no two robots the same.
    member.robot.seed += 1000 * twin.seed.value_or(0) + index++;
    agent::NavigatorConfig navigator;
    navigator.plan = setup.plan;
    navigator.follower.max_speed = std::min(twin.mission.speed, member.robot.vehicle.max_speed);
    navigator.obstacles.base_height = member.robot.vehicle.base_height;
    member.agent.navigator = std::make_shared<const agent::NavigatorConfig>(navigator);
  }
  return setup;
}

}  // namespace fleetmap::apps
