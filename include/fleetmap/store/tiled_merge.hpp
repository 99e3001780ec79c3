#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "fleetmap/cloud/voxel_tiles.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/tile_budget.hpp"
#include "fleetmap/store/tile_cache.hpp"

namespace fleetmap::store {

/// The points of one tile of a map, in the frame of the poses.
struct MapTile {
  cloud::PointCloud cloud;
  std::vector<std::uint8_t> observed_by;  ///< see MergedMap::observed_by
};
using TileSink = std::function<Status(const MapTile&)>;

/// Cost of a merge.
struct TiledMergeStats {
  std::size_t loads = 0;         ///< of submaps
  std::size_t largest_tile = 0;  ///< points
  std::size_t max_cached_bytes = 0;
};

/// merge() in memory that does not grow with the map. The first pass reads every submap once and divides the
/// site into tiles; the second merges one tile after the other from the submaps that touch it. Tiles are
/// disjoint sets of voxels, so all tiles together are the points of merge(), in the order of the tiles, and
/// within a tile in the order of merge().
class TiledMerge {
 public:
  /// The first pass. `load` must give the same cloud each time, and lives as long as this.
  static Result<TiledMerge> plan(const std::map<NodeId, Pose>& T_enu_node, SubmapLoader load,
                                 const MergeConfig& config, const TileBudget& budget = {});

  const MapOutline& outline() const { return outline_; }
  std::size_t tiles() const { return tiles_.size(); }
  /// The second pass: hands every tile to `sink`, once. Stops with the sink's error. May be repeated.
  Status stream(const TileSink& sink);
  TiledMergeStats stats() const;

 private:
  struct Source {
    NodeId id;
    Pose T_enu_node;
    std::uint8_t agent = 0;  ///< index in MapOutline::agents
    cloud::ColumnFootprint columns;
    bool readable = true;
  };
  class Planner;

  TiledMerge(SubmapLoader load, float voxel_m, bool centroids, std::size_t cache_bytes);
  Result<cloud::PointCloud> placed(const NodeId& id, const Pose& T_enu_node);
  TileCache::Parts divided(const cloud::PointCloud& placed, std::size_t from_tile) const;
  cloud::PointCloud part_of(std::size_t source, std::size_t tile);
  MapTile merged(std::size_t tile);

  SubmapLoader load_;
  float voxel_m_;
  bool centroids_;
  MapOutline outline_;
  cloud::VoxelTiles tiles_;
  std::vector<Source> sources_;
  TileCache cache_;
  std::size_t loads_ = 0;
  std::size_t largest_tile_ = 0;
};

}  // namespace fleetmap::store
