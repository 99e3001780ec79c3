#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/agent/map_files.hpp"
#include "fleetmap/agent/map_parts.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::agent {

/// The origin of ENU: `configured`, else the position of the least node id held that has a G, so that agents
/// with the same nodes agree on it; 0, 0 where none has: the map then lies nowhere on Earth. Empty while
/// there is no node.
std::optional<GeoPoint> site_origin(const store::Store& store, const std::optional<GeoPoint>& configured);

/// Everything held, by name.
std::vector<graph::Node> nodes_of(const store::Store& store);
std::vector<graph::Alignment> alignments_of(const store::Store& store);

/// Where every node of the store lies.
graph::Placement place(const store::Store& store, const GeoPoint& origin,
                       const graph::PlacementConfig& config, std::span<const NodeId> covariance_of = {});

/// What map.ply shows: MapParts::main.
store::MergedMap main_map(store::Store& store, const graph::Placement& placement,
                          const store::MergeConfig& config);

/// How a map was made: what `fleetmap map export` needs to make the same one again.
struct MapRecipe {
  GeoPoint origin;
  graph::PlacementConfig placement;
  store::MergeConfig merge;
};
/// Remembers in the store how the agent's maps are made, so that what is made of it later, whatever became of
/// the agent, is the same.
Status keep_recipe(store::Store& store, const AgentConfig& config);
/// By the last keep_recipe(); where no origin was configured, with that of what the store holds now. Empty if
/// there was none, or there is no origin yet.
std::optional<MapRecipe> map_recipe(const store::Store& store);

struct Results {
  GeoPoint origin;
  graph::Placement placement;
  MapFiles map;
  std::vector<MapPart> apart;       ///< not in map.ply, but in file_of(part)
  std::size_t missing_submaps = 0;  ///< of nodes that are held
  /// Odometry frames of which nobody knows where on Earth they are: no G in all that is tied to them.
  std::vector<graph::FrameId> not_georeferenced;
};

/// Writes map.ply, map.pcd, one more file for each part of the fleet that nobody can lay onto that map,
/// trajectory.tum, ekf.tum, alignments.csv and nodes.csv into the agent's directory. Fails when there is no
/// node yet, or a file cannot be written. Where several agents of one process hold the same set, `others`
/// spares them to merge it again: a map made of the same is copied.
Result<Results> write_results(store::Store& store, const AgentConfig& config,
                              std::span<const MapFiles> others = {});

}  // namespace fleetmap::agent
