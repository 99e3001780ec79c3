#include "fleet_to_plan.hpp"

#include <spdlog/fmt/fmt.h>

#include <iomanip>
#include <iostream>
#include <sstream>

#include "drawn_site.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_file.hpp"
#include "fleetmap/config/mission_settings.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "robot/mission_setup.hpp"
#include "twin/twin_setup.hpp"

namespace fleetmap::apps {
namespace {

/// An agent's file may be planned with before it has the origin of ENU: then at the drawing's first position.
Result<config::RobotConfig> robot_of(const std::string& site, const std::string& file,
                                     std::vector<config::Override> overrides) {
  auto robot = config::load_robot(file, overrides);
  if (robot) return robot;
  const std::optional<GeoPoint> first = first_position_of(site);
  const GeoPoint origin = first.value_or(kSomewhere);
  std::ostringstream numbers;
  numbers << std::fixed << std::setprecision(7) << '[' << origin.latitude / kDegree << ", "
          << origin.longitude / kDegree << std::setprecision(1) << ", " << origin.altitude << ']';
  overrides.push_back({"site.origin", numbers.str()});
  robot = config::load_robot(file, overrides);
  if (!robot) return tl::unexpected(robot.error());
  std::cout << file << " has no site.origin, which the robots need to drive; planned about "
            << (first ? "the drawing's first position: site: {origin: " + numbers.str() +
                            "} with the true altitude would do, the same on every robot\n"
                      : std::string("any, since the drawing is in metres\n"));
  return robot;
}

}  // namespace

Result<FleetToPlan> fleet_to_plan(const std::string& site, const std::string& file, std::size_t agents,
                                  std::vector<config::Override> overrides) {
  const auto kind =
      file.empty() ? Result<config::FileKind>(config::FileKind::kFleet) : config::check(file, overrides);
  overrides.push_back({"mission.file", absolute_path(site).string()});
  if (file.empty()) {
    auto settings = config::load_mission_settings(overrides);
    if (!settings) return tl::unexpected(settings.error());
    FleetToPlan fleet{*settings, {}, std::nullopt};
    for (std::size_t k = 1; k <= agents; ++k) {
      planning::RobotAbility& robot = fleet.robots.emplace_back();
      robot.id = *AgentId::parse(fmt::format("r{}", k));
      robot.speed = fleet.settings.speed;
    }
    return fleet;
  }
  if (!kind) return tl::unexpected(kind.error());
  if (*kind == config::FileKind::kFleet) {
    const auto config = config::load_fleet(file, overrides);
    if (!config) return tl::unexpected(config.error());
    return FleetToPlan{config->twin->mission, abilities_of(*config),
                       config->members.front().agent.site_origin};
  }
  if (*kind != config::FileKind::kRobot) return failure(file + ": give an agent's or a fleet's file");
  const auto robot = robot_of(site, file, overrides);
  if (!robot) return tl::unexpected(robot.error());
  return FleetToPlan{robot->mission->settings, robot->mission->fleet, robot->agent.site_origin};
}

}  // namespace fleetmap::apps
