#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fleetmap/output/map_crs.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {

/// Options of `fleetmap map export` that only LAS has.
struct LasOptions {
  std::optional<std::string> crs;  ///< as output::parse_crs() reads it; else the UTM zone of the origin
  std::optional<std::string> geoid;
  std::optional<std::uint32_t> tile_m;

  bool any() const { return crs || geoid || tile_m; }
};

/// Whether --out is to be LAS: FILE.las, or a folder of tiles.
bool wants_las(const std::string& out, const LasOptions& options);

/// Writes the main part of the map, prints what was written and names what was left out. Fails for a map that
/// is not georeferenced, unless it stays in its own frame. `store`: its file, as errors name it.
Status export_las(StoredMap& map, const std::string& store, const std::string& out,
                  const LasOptions& options);

}  // namespace fleetmap::apps
