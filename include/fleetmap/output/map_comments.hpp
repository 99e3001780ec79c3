#pragma once

#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Lines for the header of a point file in the map's own frame, which is of no use once the file is alone
/// without its origin: what the coordinates are, as a sentence and as WKT, the robots, the UTC of the newest
/// node, and map_hash(). `origin` is that of ENU.
std::vector<std::string> map_comments(const store::Store& store, const MapPart& part, const GeoPoint& origin,
                                      const store::MergeConfig& config);

}  // namespace fleetmap::output
