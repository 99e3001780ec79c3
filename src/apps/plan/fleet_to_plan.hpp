#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::apps {

/// The robots of a mission, its settings and the origin of ENU, if there is one.
struct FleetToPlan {
  planning::MissionConfig settings;
  std::vector<planning::RobotAbility> robots;
  std::optional<GeoPoint> origin;
};

/// Those of an agent's or a fleet's file, for the drawing `site`; without a file (empty) `agents` robots r1,
/// r2, ... of default abilities. An agent's file without an origin is planned about the drawing's first
/// position, and a line on standard output reports it.
Result<FleetToPlan> fleet_to_plan(const std::string& site, const std::string& file, std::size_t agents,
                                  std::vector<config::Override> overrides);

}  // namespace fleetmap::apps
