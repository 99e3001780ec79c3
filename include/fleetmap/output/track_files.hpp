#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/geoid.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::output {

/// The ways of all robots as placed, for GPS devices and geographic programs: WGS84, times in UTC. One track
/// for each odometry frame, with a point for each of its nodes in order. `T_enu_node`: poses in the
/// east-north-up frame at `origin`; nodes without one are left out.

/// GPX 1.1, with a waypoint for each node that has its name. Heights are above `geoid`, as GPX's readers take
/// them, else as they are: above the ellipsoid, or `above_sea_level` as GPS gave them; the file states which.
/// Fails where the geoid cannot be read, and for one if they are above sea level.
Result<std::string> to_gpx(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                           const GeoPoint& origin, const std::optional<Geoid>& geoid,
                           bool above_sea_level = false);
/// GeoJSON (RFC 7946: heights are above the ellipsoid, so there are none if they are `above_sea_level`): a
/// LineString for each track, and a Point for each node with its name, robot and time.
std::string to_geojson(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                       const GeoPoint& origin, bool above_sea_level = false);

}  // namespace fleetmap::output
