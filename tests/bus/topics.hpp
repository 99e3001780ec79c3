#pragma once

#include <string>

#include "fleetmap/bus/bus.hpp"

namespace fleetmap::bus::testing {

/// One topic of each profile.
inline const Topic kSensor{Link::kOnboard, "rt/points", "sensor_msgs::msg::dds_::PointCloud2_", "sensor"};
inline const Topic kState{Link::kOnboard, "rt/odom", "nav_msgs::msg::dds_::Odometry_", "state"};
inline const Topic kSmall{Link::kLongRange, "fleetmap/node", "fleetmap::Node", "small"};
inline const Topic kCloud{Link::kLongRange, "fleetmap/cloud", "fleetmap::CloudFragment", "cloud"};
inline const Topic kControl{Link::kShortRange, "fleetmap/request", "fleetmap::SubmapRequest", "control"};
inline const Topic kBulk{Link::kShortRange, "fleetmap/chunk", "fleetmap::SubmapChunk", "bulk"};

/// A topic of the long range for small messages.
inline Topic small_topic(const std::string& name) { return {Link::kLongRange, name, "Type", "small"}; }

}  // namespace fleetmap::bus::testing
