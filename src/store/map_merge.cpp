#include "fleetmap/store/map_merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::store {

std::uint8_t MapOutline::add_submap(const NodeId& id, const cloud::PointCloud& submap) {
  ++submaps;
  points_in += submap.size();
  for (const float intensity : submap.intensities) {
    if (std::isfinite(intensity)) max_intensity = std::max(max_intensity, intensity);
  }
  if (agents.empty() || agents.back() != id.agent) agents.push_back(id.agent);
  return static_cast<std::uint8_t>(std::min<std::size_t>(agents.size() - 1, 255));
}

MergedMap merge(const std::map<NodeId, Pose>& T_enu_node, const SubmapLoader& load,
                const MergeConfig& config) {
  cloud::VoxelMerger merger(static_cast<float>(config.voxel_m),
                            config.centroids ? cloud::VoxelPoint::centroid : cloud::VoxelPoint::first);
  MergedMap map;
  for (const auto& [id, T_enu] : T_enu_node) {
    const auto submap = load(id);
    if (!submap || !all_finite(T_enu)) {
      map.unreadable.push_back(id);
      continue;
    }
    const std::uint8_t agent = map.add_submap(id, *submap);
    const std::size_t added = merger.add(cloud::transformed(*submap, T_enu));
    // Voxels appear in the order in which they were first hit.
    map.observed_by.insert(map.observed_by.end(), added, agent);
  }
  map.points_refused = merger.refused();
  map.cloud = merger.cloud();
  map.has_intensities = map.cloud.has_intensities();
  return map;
}

}  // namespace fleetmap::store
