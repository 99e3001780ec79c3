#pragma once

#include <map>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/monitor/fleet_drawing.hpp"
#include "fleetmap/monitor/live_status.hpp"

namespace fleetmap::monitor::foxglove {

/// foxglove::FrameTransforms from "enu" to a frame with the name of each robot: its base_link at its last
/// node.
Bytes transforms_message(const std::map<AgentId, LastNode>& robots);

/// foxglove::LocationFix in the robot's frame: WGS84 of the node in ENU at `origin`, with the covariance that
/// the placement has for it.
Bytes fix_message(const AgentId& robot, const LastNode& last, const GeoPoint& origin);

/// fleetmap::RobotStatus.
Bytes status_message(const RobotNow& robot);

}  // namespace fleetmap::monitor::foxglove
