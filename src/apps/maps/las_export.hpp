#pragma once

#include <iosfwd>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/map_crs.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "las_options.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {

/// Whether --out is to be LAS: FILE.las, or a folder of tiles.
bool wants_las(const std::string& path, const LasOptions& options);

/// The reference system and geoid that the options name. `store`: its file, as errors name it.
Result<output::MapCrs> crs_of(const LasOptions& options, const StoredMap& map, const output::MapPart& part,
                              const std::string& store);

/// Writes the main part of the map, prints to `out` what was written and names what was left out. Fails for a
/// map that is not georeferenced, unless it stays in its own frame. `store`: its file, as errors name it.
Status export_las(StoredMap& map, const std::string& store, const std::string& path,
                  const LasOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
