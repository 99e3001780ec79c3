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
#include "fleetmap/store/merge_config.hpp"

namespace fleetmap::store {

/// Decoded submap of a node, in base_link of that node.
using SubmapLoader = std::function<Result<cloud::PointCloud>(const NodeId&)>;

/// All of a merged map but its points.
struct MapOutline {
  std::size_t submaps = 0;         ///< merged
  std::size_t points_in = 0;       ///< before de-duplication
  std::size_t points_refused = 0;  ///< not finite, or absurdly far away
  /// Submaps that the loader failed to read. One that fails only while tiles are merged is missing from that
  /// tile on.
  std::vector<NodeId> unreadable;
  std::vector<AgentId> agents;  ///< makers of the merged submaps
  bool has_intensities = false;
  float max_intensity = 0.0f;  ///< of all points in, in the devices' units

  /// Counts a submap, in the order of NodeIds, and returns the index of its agent in `agents`.
  std::uint8_t add_submap(const NodeId& id, const cloud::PointCloud& submap);
};

/// A merged map as one cloud.
struct MergedMap : MapOutline {
  cloud::PointCloud cloud;  ///< in the frame of the poses (ENU of the site's origin)
  /// For each point of `cloud` the index in `agents` of the agent that was first to see its voxel.
  std::vector<std::uint8_t> observed_by;
};

/// Merges a whole map: every submap is placed by `T_enu_node`, and one point is kept per voxel. Submaps are
/// loaded one by one in the order of their NodeId, so equal poses and submaps give the same map byte for byte
/// on every agent, and memory holds the merged map and one submap at most.
MergedMap merge(const std::map<NodeId, Pose>& T_enu_node, const SubmapLoader& load,
                const MergeConfig& config);

}  // namespace fleetmap::store
