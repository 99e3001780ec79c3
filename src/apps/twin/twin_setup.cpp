#include "twin_setup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/config/twin_config.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/planning/site/geojson.hpp"
#include "fleetmap/sim/parked_things.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "robot/mission_setup.hpp"

namespace fleetmap::apps {
namespace {

constexpr double kStartSpacing = 2.5;    // m between robots that set out
constexpr double kStartSearch = 60.0;    // m around the start that the drawing marks
constexpr double kStartClearance = 1.0;  // m, of free ground around a start

constexpr double kFileSlack = 10.0;  // m, that a file's rows may lie outside of the world

std::uint64_t seed_of(const config::TwinConfig& twin) { return twin.seed.value_or(1); }

/// The drawing that the fleet plans on: the mission's file, or one of the world that is off by `map_error`.
/// Starts that the fleet's file names are marked in it, as imprecisely as all the rest.
Result<planning::Mission> drawn_site(const config::FleetConfig& config, const sim::World& world,
                                     const GeoPoint& origin) {
  const config::TwinConfig& twin = *config.twin;
  if (!twin.mission.file.empty()) {
    auto site = planning::read_geojson(twin.mission.file, LocalFrame(origin));
    if (!site) return site;
    const Eigen::Vector2d slack = Eigen::Vector2d::Constant(kFileSlack);
    const Status within =
        planning::check_within(*site, world.bounds().low - slack, world.bounds().high + slack);
    if (!within) return failure(twin.mission.file.string() + ": " + within.error().message);
    return site;
  }
  if (world.aisles().empty()) {
    return failure(
        twin.world.string() +
        ": the world has no aisles; name them there (aisles: [[[x, y], [x, y]]]) or give the mission "
        "a drawing with rows (mission.file: SITE.geojson)");
  }
  sim::SiteDrawing drawing = world.drawing();
  std::vector<AgentId> marked;
  for (const auto& member : config.members) {
    if (!member.robot.has_start) continue;
    drawing.marks.push_back(member.robot.start);
    marked.push_back(member.agent.id);
  }
  drawing = sim::with_position_error(drawing, twin.map_error, seed_of(twin));
  planning::Mission site = mission_on(drawing);
  for (std::size_t k = 0; k < marked.size(); ++k) site.starts.push_back({marked[k], drawing.marks[k]});
  return site;
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

/// Robots that the fleet's file gives no start stand about where the drawing marks it.
Status assign_starts(config::FleetConfig& config, const sim::World& world, const planning::Mission& site) {
  std::vector<Eigen::Vector2d> taken;
  std::size_t open = 0;
  for (const auto& member : config.members) {
    if (member.robot.has_start) taken.push_back(member.robot.start);
    open += !member.robot.has_start;
  }
  const planning::Polyline& first = site.rows.front().waypoints;
  const Eigen::Vector2d ahead = first.back() - first.front();
  const auto common = std::ranges::find(site.starts, std::optional<AgentId>(), &planning::StartPoint::agent);
  const auto places =
      free_places(world, common == site.starts.end() ? first.front() : common->at, open, taken);
  if (places.size() < open) {
    return failure(
        config.twin->world.string() + ": no free ground for " + std::to_string(open) +
        " robots near the start of the mission; give each agent robot.start: [east, north, yaw_deg]");
  }
  auto place = places.begin();
  for (auto& member : config.members) {
    if (member.robot.has_start) continue;
    member.robot.has_start = true;
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

/// Plans on `site` and gives every agent its navigator.
Status plan_twin(config::FleetConfig& config, const planning::Mission& site, const GeoPoint& origin,
                 std::shared_ptr<const planning::FleetPlan>& plan) {
  const config::TwinConfig& twin = *config.twin;
  auto planned = plan_on(site, abilities_of(config), twin.mission);
  if (!planned) return failure(twin.mission_at + ": " + planned.error().message);
  plan = std::move(*planned);
  for (auto& member : config.members) {
    member.agent.site_origin = origin;
    agent::NavigatorConfig navigator;
    navigator.plan = plan;
    navigator.follower.max_speed = std::min(twin.mission.speed, member.robot.vehicle.max_speed);
    navigator.obstacles.base_height = member.robot.vehicle.base_height;
    member.agent.navigator = std::make_shared<const agent::NavigatorConfig>(navigator);
  }
  return {};
}

GeoPoint origin_of(const config::FleetConfig& config) {
  return config.members.front().agent.site_origin.value_or(kSomewhere);
}

}  // namespace

Result<TwinSetup> set_up_twin(config::FleetConfig& config) {
  const config::TwinConfig& twin = *config.twin;
  auto world = config::make_world(twin.world, twin.seed);
  if (!world) return tl::unexpected(world.error());
  TwinSetup setup;
  setup.world = *world;
  setup.origin = origin_of(config);
  auto site = drawn_site(config, *setup.world, setup.origin);
  if (!site) return tl::unexpected(site.error());
  setup.site = std::move(*site);
  if (const Status started = assign_starts(config, *setup.world, setup.site); !started)
    return tl::unexpected(started.error());
  if (twin.unknown_obstacles > 0) {
    std::vector<Eigen::Vector2d> starts;
    for (const auto& member : config.members) starts.push_back(member.robot.start);
    auto cluttered = sim::with_parked_things(*setup.world, twin.unknown_obstacles, seed_of(twin), starts);
    if (!cluttered) return failure(twin.mission_at + ".unknown_obstacles: " + cluttered.error().message);
    setup.world = *cluttered;
  }
  if (const Status free = check_starts(config, setup.world, setup.origin); !free)
    return tl::unexpected(free.error());
  if (const Status driven = check_scan_rates(config); !driven) return tl::unexpected(driven.error());
  if (const Status planned = plan_twin(config, setup.site, setup.origin, setup.plan); !planned)
    return tl::unexpected(planned.error());
  std::uint64_t index = 0;
  // Another seed of the run gives every robot other errors, and no two robots the same.
  for (auto& member : config.members) member.robot.seed += 1000 * twin.seed.value_or(0) + index++;
  return setup;
}

Status set_up_agents(config::FleetConfig& config) {
  if (config.twin->mission.file.empty()) {
    const auto setup = set_up_twin(config);
    return setup ? Status() : tl::unexpected(setup.error());
  }
  const GeoPoint origin = origin_of(config);
  const auto site = planning::read_geojson(config.twin->mission.file, LocalFrame(origin));
  if (!site) return tl::unexpected(site.error());
  std::shared_ptr<const planning::FleetPlan> plan;
  return plan_twin(config, *site, origin, plan);
}

}  // namespace fleetmap::apps
