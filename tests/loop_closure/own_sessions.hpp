#pragma once

#include "fleetmap/geometry/geodesy.hpp"
#include "support/robots.hpp"

namespace fleetmap::loop_closure {

using fleetmap::testing::kSelf;  // maps a site on several days

/// The origin of the site.
inline const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

}  // namespace fleetmap::loop_closure
