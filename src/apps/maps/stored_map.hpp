#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/run_evaluation/map_pictures.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::apps {

/// A store with all that its map is made of.
struct StoredMap {
  store::Store store;
  output::MapRecipe recipe;
  output::MapItems items;
  graph::Placement placement;  ///< of these items
};

/// The part of a store that a map is made of, and how.
struct MapSelection {
  std::optional<GeoPoint> origin;  ///< of ENU; else that of the agent's last map, or the least node's
  std::optional<double> voxel_m;   ///< else as in the agent's last map
  std::vector<AgentId> without;    ///< robots whose nodes and alignments are left out
};
/// Fails with the name that is none.
Result<std::vector<AgentId>> robots_named(const std::vector<std::string>& names);

/// Fails, with the remedy, unless the file is a store.
Status check_store(const std::filesystem::path& file);

/// Places the nodes of a store. Fails for a robot to be left out of which it holds nothing.
Result<StoredMap> open_map(const std::filesystem::path& file, const MapSelection& selection);

/// Poses of the nodes that map.ply contains.
std::map<NodeId, Pose> shown_poses(const StoredMap& map);

/// The map's pictures, in memory for a map that is thinned to what can be drawn: its tiles come once for
/// their points and once to be counted around these.
Result<std::vector<run_evaluation::MapPicture>> pictures_of(StoredMap& map);

/// Prints which robots' submaps the store lacks, so that the map has holes.
void name_holes(const StoredMap& map);

/// Prints the submaps that are left out.
void name_unreadable(const store::MapOutline& outline);

}  // namespace fleetmap::apps
