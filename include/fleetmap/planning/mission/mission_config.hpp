#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/division/division_config.hpp"
#include "fleetmap/planning/division/rendezvous_config.hpp"
#include "fleetmap/planning/mission/executive_config.hpp"
#include "fleetmap/planning/routes/route_planner_config.hpp"
#include "fleetmap/planning/site/row_selection.hpp"

namespace fleetmap::planning {

/// All of a mission's settings; the same on every robot.
struct MissionConfig {
  std::filesystem::path file;  ///< GeoJSON of the site; empty: the twin plans on a drawing of its world
  RowSelection rows;
  bool rendezvous = true;
  double speed = 1.5;  ///< m/s, of robots that name none
  DivisionConfig division;
  RoutePlannerConfig routes;
  RendezvousConfig meeting;
  ExecutiveConfig executive;
  Status validate() const;
};

}  // namespace fleetmap::planning
