#pragma once

#include <nlohmann/json.hpp>

#include "fleetmap/store/store.hpp"

namespace fleetmap::apps {

/// How many nodes, alignments and whole submaps (with the bytes of all submaps, whole or in part) a store
/// holds, of all and of each robot, and `hash`: equal for stores that hold the same items, whoever they
/// belong to.
nlohmann::json summary_of(const store::Store& store);

}  // namespace fleetmap::apps
