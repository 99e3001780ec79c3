#pragma once

#include <filesystem>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/store/map_merge.hpp"

namespace fleetmap::run_evaluation {

/// The nodes and alignments of an agent, and their poses in its last results.
struct StoredFleet {
  store::Store store;
  output::MapRecipe recipe;
  std::vector<graph::Alignment> alignments;  ///< those of the store
  graph::Placement placement;
};
/// Fails when no map was made of the store yet.
Result<StoredFleet> open_stored(const std::filesystem::path& store_file);

/// The map made again from the agent's store, so that each point has the robot that observed it.
store::MergedMap map_with_sources(StoredFleet& held);

}  // namespace fleetmap::run_evaluation
