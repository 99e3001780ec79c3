#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "alignment_certainty.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/exchange/store_union.hpp"
#include "fleetmap/loop_closure/map_sessions.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::apps {

/// Two of the stores that were merged.
struct DayPair {
  std::size_t earlier = 0, later = 0;  ///< index of the store
  loop_closure::MapSessionAlignments alignments;
  std::size_t used = 0;          ///< alignments between the two days that the placement uses
  AlignmentCertainty certainty;  ///< of these
  bool joined = false;           ///< a frame of one lies in a component with a frame of the other
  bool frames_shared = false;    ///< an odometry frame is in both stores
  std::string why_not;           ///< joined, for people
};

struct MergedStore {
  std::vector<exchange::StoreUnion> unions;    ///< of each store
  std::vector<loop_closure::MapSession> days;  ///< of each store
  std::vector<DayPair> pairs;
  output::MapRecipe recipe;    ///< that of the first store
  graph::Placement placement;  ///< of all items
};

/// Writes all items of `stores`, and alignments between each two of them, into the new store `out`, which
/// belongs to the robot "merged". The file appears whole or not at all. With `keys` (a member's folder) only
/// items count that their makers signed. Fails if `out` exists, or if the stores hold no node.
Result<MergedStore> merge_stores(const std::vector<std::filesystem::path>& stores,
                                 const std::filesystem::path& out,
                                 const std::optional<std::filesystem::path>& keys);

}  // namespace fleetmap::apps
