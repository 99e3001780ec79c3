#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stored_map.hpp"

namespace fleetmap::apps {

/// Each writes files of a placed store and returns a sentence, for a person, on what was written.

/// The main part of the map in ENU, PLY or PCD by the file's name. Names submaps that cannot be read. Fails
/// for a map without a point; `store` is its file, as the error names it, here and below.
Result<std::string> export_points(StoredMap& map, const std::string& store, const std::filesystem::path& out);

/// The nodes of all robots in WGS84, GPX or else GeoJSON by the file's name; heights of GPX are above the
/// geoid if one is named. Fails for a map without GPS.
Result<std::string> export_tracks(const StoredMap& map, const std::string& store,
                                  const std::filesystem::path& out,
                                  const std::optional<std::string>& geoid_name = std::nullopt);

/// The graph as g2o, and the names of its vertices in `out`.csv.
Result<std::string> export_graph(const StoredMap& map, const std::filesystem::path& out);

/// Pictures of the map in the folder `out`, which is made. Returns their paths.
Result<std::vector<std::filesystem::path>> export_pictures(StoredMap& map, const std::string& store,
                                                           const std::filesystem::path& out);

}  // namespace fleetmap::apps
