#pragma once

#include <map>
#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::output {

/// The ways of all robots as placed, for GPS devices and geographic programs: WGS84, heights in metres above
/// the ellipsoid, times in UTC. One track for each odometry frame, with a point for each of its nodes in
/// order. `T_enu_node`: poses in the east-north-up frame at `origin`; nodes without one are left out.

/// GPX 1.1.
std::string to_gpx(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                   const GeoPoint& origin);
/// GeoJSON (RFC 7946): a LineString for each track, and a Point for each node with its name, robot and time.
std::string to_geojson(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                       const GeoPoint& origin);

}  // namespace fleetmap::output
