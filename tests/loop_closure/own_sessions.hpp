#pragma once

#include "fleetmap/core/ids.hpp"
#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap::loop_closure {

/// The robot that maps a site on several days, and the origin of the site.
inline const AgentId kSelf = AgentId::parse("r1").value();
inline const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

}  // namespace fleetmap::loop_closure
