#pragma once

#include <memory>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/planning/site/mission.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::apps {

/// The origin of sites that name none: that of the fleets in config/.
inline const GeoPoint kSomewhere = geo_point_from_degrees(39.0, -3.0, 600.0);

/// The digital twin, ready to run: its world, where its robots begin and what they are to do.
struct TwinSetup {
  std::shared_ptr<const sim::World> world;
  GeoPoint origin;
  planning::Mission site;  ///< the whole drawing that the fleet plans on
  std::shared_ptr<const planning::FleetPlan> plan;
};

/// Builds the world, chooses starts for robots that name none (written into `config`), plans the mission on a
/// drawing of the site and gives every agent its navigator. The planner gets neither the world nor where the
/// robots really start. Errors name the world's or mission's file, or the robot, and the remedy.
Result<TwinSetup> set_up_twin(config::FleetConfig& config);
/// For the agents alone, as processes of their own: the same plan. The world is built only if the fleet's
/// file names no drawing.
Status set_up_agents(config::FleetConfig& config);

}  // namespace fleetmap::apps
