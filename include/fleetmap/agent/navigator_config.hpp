#pragma once

#include <chrono>
#include <memory>

#include "fleetmap/agent/drive_guard_config.hpp"
#include "fleetmap/agent/obstacle_config.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/planning/driving/path_follower_config.hpp"
#include "fleetmap/planning/mission/fleet_plan.hpp"

namespace fleetmap::agent {

/// A robot's part in a mission: the fleet's plan, the path follower and its guards.
struct NavigatorConfig {
  /// The whole fleet's plan: the same on every robot.
  std::shared_ptr<const planning::FleetPlan> plan;
  planning::PathFollowerConfig follower;
  ObstacleConfig obstacles;
  DriveGuardConfig guard;
  Duration report_period = std::chrono::seconds(5);
};

}  // namespace fleetmap::agent
