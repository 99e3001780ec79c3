#pragma once

#include <filesystem>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/store/map_merge.hpp"

namespace fleetmap::run_evaluation {

/// The nodes and alignments of an agent, and their poses in its last results.
struct HeldFleet {
  store::Store store;
  output::MapRecipe recipe;
  std::vector<graph::Alignment> alignments;  ///< those of the store
  graph::Placement placement;
};
/// Fails when no map was made of the store yet.
Result<HeldFleet> open_held(const std::filesystem::path& store_file);

/// The map made again from the agent's store, so that each point has the robot that observed it.
store::MergedMap map_with_sources(HeldFleet& held);

}  // namespace fleetmap::run_evaluation
