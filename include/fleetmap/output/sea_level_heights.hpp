#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Stores that GPS gave heights above mean sea level, so that exports do not claim them above the ellipsoid.
/// It is of the whole store, since its sessions and robots share one map, and final.
Status keep_sea_level_heights(store::Store& store);
/// False as well for a store that an older program wrote.
bool has_sea_level_heights(const store::Store& store);

}  // namespace fleetmap::output
