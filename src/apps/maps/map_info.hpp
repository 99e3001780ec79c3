#pragma once

#include <iosfwd>

#include "stored_map.hpp"

namespace fleetmap::apps {

/// Prints what a placed store holds: counts, the origin of ENU, frames that alignments join, and robots whose
/// items contradict the fleet.
void print_info(std::ostream& out, const StoredMap& map);

}  // namespace fleetmap::apps
