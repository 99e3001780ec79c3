#pragma once

#include <memory>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/fleet_plan.hpp"
#include "fleetmap/sim/world.hpp"

namespace fleetmap::apps {

/// The digital twin, ready to run: its world, where its robots begin and what they are to do.
struct TwinSetup {
  std::shared_ptr<const sim::World> world;
  GeoPoint origin;
  std::shared_ptr<const planning::FleetPlan> plan;
};

/// Builds the world, chooses starts for robots that name none (written into `config`), plans the mission and
/// gives every agent its navigator. Errors name the world's or mission's file, or the robot, and the remedy.
Result<TwinSetup> set_up_twin(config::FleetConfig& config);

}  // namespace fleetmap::apps
