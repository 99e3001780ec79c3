#pragma once

#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Lines for the header of a point file in the map's own frame, which is of no use once the file is alone
/// without its origin: what the coordinates are, and the UTC of the newest node. `origin` is that of ENU.
std::vector<std::string> map_comments(const store::Store& store, const MapPart& part, const GeoPoint& origin);

}  // namespace fleetmap::output
