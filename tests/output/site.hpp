#pragma once

#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap::testing {

/// Origin of the site whose results are written.
inline const GeoPoint kSite = geo_point_from_degrees(48.0, 11.0, 500.0);

}  // namespace fleetmap::testing
