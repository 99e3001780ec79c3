#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/graph/contradictions.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/results_config.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Placement and files that write_results() left.
struct Results {
  GeoPoint origin;
  graph::Placement placement;
  MapFiles map;
  std::vector<MapPart> apart;       ///< not in map.ply, but in file_of(part)
  std::size_t missing_submaps = 0;  ///< of nodes that are held
  /// Odometry frames without a georeference: no node of a frame that alignments join to them has G.
  std::vector<graph::FrameId> not_georeferenced;
  std::map<AgentId, graph::Contradiction> contradicting;  ///< agents that contradict the fleet
};

/// Writes map.ply, map.pcd, one more file for each part of the fleet that no alignment joins to that map,
/// trajectory.tum, ekf.tum, alignments.csv and nodes.csv into the agent's directory. Fails when there is no
/// node yet, or a file cannot be written. Where several agents of one process hold the same set, `others`
/// spares them to merge it again: a map made of the same is copied. `load` reads the submaps of a map that is
/// merged; empty: store::decoded_submaps() does.
Result<Results> write_results(store::Store& store, const ResultsConfig& config,
                              std::span<const MapFiles> others = {}, const store::SubmapLoader& load = {});

}  // namespace fleetmap::output
