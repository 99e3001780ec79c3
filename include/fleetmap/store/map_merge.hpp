#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::store {

/// Decoded submap of a node, in base_link of that node.
using SubmapLoader = std::function<Result<cloud::PointCloud>(const NodeId&)>;

struct MergeConfig {
  double voxel_m = 0.1;    ///< m, edge of the grid in the site's frame; one point is kept in each voxel
  bool centroids = false;  ///< the mean of a voxel's points rather than the first of them
  Status validate() const;
};

/// All of a merged map but its points.
struct MapOutline {
  std::size_t submaps = 0;         ///< merged
  std::size_t points_in = 0;       ///< before de-duplication
  std::size_t points_refused = 0;  ///< not finite, or absurdly far away
  /// Submaps that the loader could not give, left out: one that can no longer be read while tiles are merged,
  /// from the tile on that it was needed for.
  std::vector<NodeId> unreadable;
  std::vector<AgentId> agents;  ///< whose submaps the map is made of
  bool has_intensities = false;

  /// Counts a submap, in the order of NodeIds, and returns the index of its agent in `agents`.
  std::uint8_t add_submap(const NodeId& id, std::size_t points);
};

struct MergedMap : MapOutline {
  cloud::PointCloud cloud;  ///< in the frame of the poses (ENU of the site's origin)
  /// For each point of `cloud` the index in `agents` of the agent that was first to see its voxel.
  std::vector<std::uint8_t> seen_by;
};

/// The whole map: every submap put where `T_enu_node` says, one point a voxel. Submaps are loaded one by one
/// in the order of their NodeId, so equal poses and submaps give the same map byte for byte on every agent,
/// and memory stays within that of the merged map and one submap.
MergedMap merge(const std::map<NodeId, Pose>& T_enu_node, const SubmapLoader& load,
                const MergeConfig& config);

}  // namespace fleetmap::store
