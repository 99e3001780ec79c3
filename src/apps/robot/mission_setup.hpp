#pragma once

#include <memory>
#include <vector>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"
#include "fleetmap/sim/site_drawing.hpp"

namespace fleetmap::apps {

/// The mission that a file of the drawing holds: each lane is a row, and robots set out at the beginning of
/// the first lane.
planning::Mission mission_on(const sim::SiteDrawing& drawing);

/// Abilities of the robots of a fleet of the twin, without their starts.
std::vector<planning::RobotAbility> abilities_of(const config::FleetConfig& config);

/// Divides the rows of `site` that `settings` select. All robots compute the same plan, since it follows from
/// the drawing and the abilities alone: `fleet` gets the starts that the drawing marks, not where robots
/// really are.
Result<std::shared_ptr<const planning::FleetPlan>> plan_on(planning::Mission site,
                                                           std::vector<planning::RobotAbility> fleet,
                                                           const planning::MissionConfig& settings);

/// Plans the mission of an agent's own file and gives the agent its navigator. Errors name file, line and
/// key.
Status plan_mission(config::RobotConfig& robot);

}  // namespace fleetmap::apps
