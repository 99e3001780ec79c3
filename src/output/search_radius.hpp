#pragma once

#include <optional>

#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::output {

/// Stores the largest radius (m) within which the robot searches for loop candidates, r_max of Eq. 1: why two
/// robots were not registered depends on it.
Status keep_search_radius(store::Store& store, double radius_m);
/// Empty for a store that an older program wrote.
std::optional<double> search_radius(const store::Store& store);

}  // namespace fleetmap::output
