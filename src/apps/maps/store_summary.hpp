#pragma once

#include <nlohmann/json.hpp>

#include "fleetmap/store/store.hpp"

namespace fleetmap::apps {

/// Numbers of nodes, alignments and whole submaps (with the bytes of all submaps, whole or in part) of a
/// store, in total and for each robot, and `hash`, which is equal for stores that hold the same items, of
/// whichever robot.
nlohmann::json summary_of(const store::Store& store);

}  // namespace fleetmap::apps
