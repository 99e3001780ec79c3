#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::planning {

using RowId = std::uint32_t;

/// Waypoints that one robot drives in one go, in order or in reverse: a row of the site (paper, section 4).
struct Row {
  RowId id = 0;
  std::vector<Eigen::Vector2d> waypoints;  ///< ENU, m, at least two
};

/// Ground that may not be driven on: a closed polygon in ENU, m.
using KeepOut = std::vector<Eigen::Vector2d>;

/// What the fleet is to drive: the same on every robot. Everything in the ENU frame of the site, metres.
struct Mission {
  std::vector<Row> rows;
  std::vector<KeepOut> keep_out;
  Status validate() const;
};

/// Position and heading of base_link in ENU.
struct Pose2 {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  double yaw = 0.0;                                    ///< rad, from east, counter-clockwise
};

/// What a robot can do; the fleet's robots may differ.
struct RobotAbility {
  AgentId id;
  Pose2 start;
  double speed = 1.5;          ///< m/s
  double yaw_rate = 1.0;       ///< rad/s
  double battery_wh = 270.0;   ///< Wh left at the start
  double power_idle_w = 40.0;  ///< W, computer and sensors
  double energy_per_metre_wh = 0.03;
};

}  // namespace fleetmap::planning
