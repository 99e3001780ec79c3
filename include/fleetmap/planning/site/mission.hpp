#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::planning {

using RowId = std::uint32_t;
/// Points joined by straight lines, ENU, m.
using Polyline = std::vector<Eigen::Vector2d>;

/// Waypoints that one robot drives in one go, in order or in reverse: a row of the site (paper, section 4).
struct Row {
  RowId id = 0;
  Polyline waypoints;  ///< ENU, m, at least two
};

/// Ground that may not be driven on: a closed polygon in ENU, m.
using KeepOut = std::vector<Eigen::Vector2d>;

/// A place at which robots set out, ENU, m. It is marked on the site's drawing, so it is right to metres
/// only.
struct StartPoint {
  std::optional<AgentId> agent;  ///< absent: every robot that has no start of its own
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
};

/// Rows and places that the fleet drives, the same on every robot. Everything is in ENU of the site, metres.
struct Mission {
  static constexpr std::size_t kMaxRows = 1024;
  static constexpr std::size_t kMaxPoints = 1'000'000;  ///< of all rows and keep-outs together

  std::vector<Row> rows;  ///< in the order in which they lie across the site
  std::vector<KeepOut> keep_out;
  std::optional<KeepOut> boundary;  ///< routes stay inside; without it, near rows and keep-outs
  std::vector<StartPoint> starts;   ///< at most one a robot and one for all others

  /// The start of a robot: its own, else the common one, else the first waypoint of the first row.
  Eigen::Vector2d start_of(const AgentId& agent) const;
  /// At least one row, ids unique, two waypoints a row, polygons of three corners, all finite and near the
  /// origin (100 km), within the limits above. Says which row breaks which rule.
  Status validate() const;
};

/// Position and heading of base_link in ENU.
struct Pose2 {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  double yaw = 0.0;                                    ///< rad, from east, counter-clockwise
};

/// Abilities of a robot; the robots of a fleet may differ.
struct RobotAbility {
  AgentId id;
  Pose2 start;
  double speed = 1.5;          ///< m/s
  double yaw_rate = 1.0;       ///< rad/s
  double battery_wh = 270.0;   ///< Wh left at the start
  double power_idle_w = 40.0;  ///< W, computer and sensors
  double energy_per_metre_wh = 0.03;
  Status validate() const;
};

/// m
double length_of(std::span<const Eigen::Vector2d> line);

/// Every waypoint lies within [low, high]; else says which row and waypoint does not, by how much, and what
/// to do.
Status check_within(const Mission& mission, const Eigen::Vector2d& low, const Eigen::Vector2d& high);

}  // namespace fleetmap::planning
