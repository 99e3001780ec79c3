#pragma once

#include <iosfwd>
#include <string>

#include "fleetmap/core/result.hpp"
#include "map_options.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {

/// Writes the main part of the map as GeoTIFFs of heights and a hillshade into the new folder `options.out`,
/// prints to `out` what was written and names what was left out. Fails for a map that is not georeferenced,
/// unless it stays in its own frame, and where GDAL is missing.
Status export_elevation(StoredMap& map, const MapOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
