#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/store/store.hpp"
#include "fleetmap/store/tiled_merge.hpp"

namespace fleetmap::output {

/// The map of those nodes whose submaps the store holds, in the frame that their poses are in: as a whole, or
/// planned to be merged tile by tile. `store` must outlive the latter. `load` reads the submaps, here and
/// below; empty: store::decoded_submaps() does.
store::MergedMap merged_map(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                            const store::MergeConfig& config);
Result<store::TiledMerge> tiled_map(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                                    const store::MergeConfig& config, store::SubmapLoader load = {});
/// Fails, with the cause and the remedy, if no point of a planned map can be used.
Status require_points(const store::MapOutline& outline);

/// Outline and number of points of a map that was written.
struct WrittenMap {
  store::MapOutline outline;
  std::size_t points = 0;
};
/// Merges that map tile by tile into each of `files` (.ply or .pcd), all or none of which appear unless one
/// cannot be renamed. `comments` are lines for their headers.
Result<WrittenMap> write_merged(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                                const store::MergeConfig& config,
                                std::span<const std::filesystem::path> files,
                                const std::vector<std::string>& comments = {},
                                const store::SubmapLoader& load = {});
/// The same of a map that is planned.
Result<WrittenMap> write_planned(store::TiledMerge& merge, std::span<const std::filesystem::path> files,
                                 const std::vector<std::string>& comments = {});

/// Hash of all that a map is a function of: submaps, their poses, how they are merged. Equal on agents that
/// hold the same set.
ContentHash map_hash(const store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                     const store::MergeConfig& config);

/// The files of one merged map.
struct MapFiles {
  std::filesystem::path directory;
  ContentHash made_of{};  ///< map_hash()
  std::size_t points = 0;
  std::size_t submaps = 0;
  std::string hash;  ///< content hash of map.ply: equal on agents that hold the same set
};

/// Writes map.ply and map.pcd into `directory`, or copies those of `others` that are made of the
/// same. Warns of submaps that cannot be read and leaves them out. `comments` are lines for the headers, here
/// and below.
Result<MapFiles> write_map(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                           const store::MergeConfig& config, const std::filesystem::path& directory,
                           std::span<const MapFiles> others, const std::vector<std::string>& comments,
                           const store::SubmapLoader& load = {});
/// Writes file_of(part) and returns how many submaps it shows.
Result<std::size_t> write_part(store::Store& store, const MapPart& part, const store::MergeConfig& config,
                               const std::filesystem::path& directory,
                               const std::vector<std::string>& comments,
                               const store::SubmapLoader& load = {});
/// Removes the parts of an earlier run, since nodes that could not be placed then may be in the map now.
void remove_parts(const std::filesystem::path& directory);
/// Removes temporary files, up to gigabytes, of a program that was killed while it merged a map.
void remove_unfinished_maps(const std::filesystem::path& directory);

}  // namespace fleetmap::output
