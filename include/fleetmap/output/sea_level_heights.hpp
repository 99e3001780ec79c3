#pragma once

#include <set>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Stores that GPS gave heights above mean sea level, so that exports do not claim them above the ellipsoid.
/// It is of the whole store, since its sessions and robots share one map, and final.
Status keep_sea_level_heights(store::Store& store);
/// False as well for a store that an older program wrote.
bool has_sea_level_heights(const store::Store& store);

/// Stores of which robots, beside its own, the kind of heights is that of has_sea_level_heights(): of a
/// merged store.
Status keep_known_heights(store::Store& store, const std::set<AgentId>& robots);
/// These robots and the store's own.
std::set<AgentId> known_heights(const store::Store& store);
/// Makers of nodes with G whose kind of height the store does not hold: messages between robots have no room
/// for it.
std::set<AgentId> unknown_heights(const store::Store& store);

}  // namespace fleetmap::output
