#include "fleetmap/store/tiled_merge.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "fleetmap/cloud/voxel_sample.hpp"

namespace fleetmap::store {

/// The first pass: what is found out about the submaps one by one.
class TiledMerge::Planner {
 public:
  Planner(TiledMerge& merge, const TileBudget& budget)
      : merge_(merge), budget_(budget), sample_(budget.sample_voxels) {}

  void add(const NodeId& id, const Pose& T_enu_node) {
    MapOutline& outline = merge_.outline_;
    auto placed = merge_.placed(id, T_enu_node);
    if (!placed) {
      outline.unreadable.push_back(id);
      return;
    }
    const std::uint8_t agent = outline.add_submap(id, *placed);
    all_intensities_ = all_intensities_ && (placed->empty() || placed->has_intensities());
    merge_.sources_.push_back({id, T_enu_node, agent, columns_of(*placed), true});
    keep(std::move(*placed));
  }

  void finish() {
    MapOutline& outline = merge_.outline_;
    outline.has_intensities = all_intensities_ && outline.points_in > outline.points_refused;
    merge_.tiles_ = cloud::VoxelTiles(sample_, budget_.tile_voxels);
    for (auto& [source, placed] : kept_) {
      merge_.cache_.put(source, merge_.divided(placed, 0));
      placed = {};
    }
  }

 private:
  cloud::ColumnFootprint columns_of(const cloud::PointCloud& placed) {
    cloud::ColumnFootprint columns;
    for (const Eigen::Vector3f& point : placed.points) {
      const auto voxel = cloud::voxel_of(point, static_cast<double>(merge_.voxel_m_));
      if (!voxel) {
        ++merge_.outline_.points_refused;
        continue;
      }
      sample_.add(*voxel);
      columns.add(cloud::column_code(*voxel));
    }
    columns.finish();
    return columns;
  }

  /// A small map is read once.
  void keep(cloud::PointCloud placed) {
    const std::size_t bytes = bytes_of(placed);
    if (kept_bytes_ + bytes > budget_.cache_bytes) return;
    kept_bytes_ += bytes;
    kept_.emplace(merge_.sources_.size() - 1, std::move(placed));
  }

  TiledMerge& merge_;
  const TileBudget& budget_;
  cloud::VoxelSample sample_;
  bool all_intensities_ = true;
  std::map<std::size_t, cloud::PointCloud> kept_;
  std::size_t kept_bytes_ = 0;
};

TiledMerge::TiledMerge(SubmapLoader load, float voxel_m, bool centroids, std::size_t cache_bytes)
    : load_(std::move(load)), voxel_m_(voxel_m), centroids_(centroids), cache_(cache_bytes) {}

Result<TiledMerge> TiledMerge::plan(const std::map<NodeId, Pose>& T_enu_node, SubmapLoader load,
                                    const MergeConfig& config, const TileBudget& budget) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  TiledMerge merge(std::move(load), static_cast<float>(config.voxel_m), config.centroids, budget.cache_bytes);
  Planner planner(merge, budget);
  for (const auto& [id, T] : T_enu_node) planner.add(id, T);
  planner.finish();
  return merge;
}

Result<cloud::PointCloud> TiledMerge::placed(const NodeId& id, const Pose& T_enu_node) {
  ++loads_;
  const auto submap = load_(id);
  if (!submap) return submap;
  if (!all_finite(T_enu_node)) return failure(to_string(id) + ": its pose is not finite");
  return cloud::transformed(*submap, T_enu_node);
}

TileCache::Parts TiledMerge::divided(const cloud::PointCloud& placed, std::size_t from_tile) const {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> tile_of(placed.size(), kNone);
  std::map<std::size_t, std::size_t> counts;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const auto voxel = cloud::voxel_of(placed.points[i], static_cast<double>(voxel_m_));
    if (!voxel) continue;
    const std::size_t tile = tiles_.tile_of(cloud::column_code(*voxel));
    if (tile < from_tile) continue;
    tile_of[i] = static_cast<std::uint32_t>(tile);
    ++counts[tile];
  }
  TileCache::Parts parts;
  std::vector<cloud::PointCloud*> part_of(tiles_.size(), nullptr);
  for (const auto& [tile, count] : counts) {
    cloud::PointCloud& part = parts[tile];
    part.points.reserve(count);
    if (placed.has_intensities()) part.intensities.reserve(count);
    part_of[tile] = &part;
  }
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (tile_of[i] == kNone) continue;
    part_of[tile_of[i]]->points.push_back(placed.points[i]);
    if (placed.has_intensities()) part_of[tile_of[i]]->intensities.push_back(placed.intensities[i]);
  }
  return parts;
}

cloud::PointCloud TiledMerge::part_of(std::size_t index, std::size_t tile) {
  if (cache_.holds(index)) return cache_.take(index, tile);
  Source& source = sources_[index];
  const auto cloud = placed(source.id, source.T_enu_node);
  if (!cloud) {
    source.readable = false;
    --outline_.submaps;
    outline_.unreadable.insert(std::ranges::upper_bound(outline_.unreadable, source.id), source.id);
    return {};
  }
  TileCache::Parts parts = divided(*cloud, tile);
  cloud::PointCloud part;
  if (const auto here = parts.find(tile); here != parts.end()) {
    part = std::move(here->second);
    parts.erase(here);
  }
  cache_.put(index, std::move(parts));
  return part;
}

MapTile TiledMerge::merged(std::size_t tile) {
  MapTile result;
  cloud::VoxelMerger merger(voxel_m_, centroids_ ? cloud::VoxelPoint::centroid : cloud::VoxelPoint::first);
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const Source& source = sources_[k];
    if (!source.readable || !source.columns.touches(tiles_.first_code(tile), tiles_.last_code(tile)))
      continue;
    const std::size_t added = merger.add(part_of(k, tile));
    // Voxels appear in the order in which they were first hit.
    result.observed_by.insert(result.observed_by.end(), added, source.agent);
  }
  result.cloud = merger.cloud();
  if (!outline_.has_intensities) result.cloud.intensities.clear();
  return result;
}

Status TiledMerge::stream(const TileSink& sink) {
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    const MapTile points = merged(tile);
    largest_tile_ = std::max(largest_tile_, points.cloud.size());
    if (const Status taken = sink(points); !taken) {
      cache_.clear();
      return taken;
    }
  }
  cache_.clear();
  return {};
}

TiledMergeStats TiledMerge::stats() const { return {loads_, largest_tile_, cache_.peak_bytes()}; }

}  // namespace fleetmap::store
