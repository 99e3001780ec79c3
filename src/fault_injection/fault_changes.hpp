#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fleetmap/fault_injection/scenario.hpp"

namespace fleetmap::fault_injection {

/// A moment at which a fault of a scenario changes the fleet.
struct FaultChange {
  Duration at;            ///< since the fleet's start
  std::size_t fault = 0;  ///< index in Scenario::faults
  enum class Kind : std::uint8_t { kBackup, kBegin, kEnd } kind = Kind::kBegin;
};

/// All changes in the order of time; faults end with the mapping at the latest. A store that comes back later
/// is copied first.
std::vector<FaultChange> changes_of(const Scenario& scenario);

}  // namespace fleetmap::fault_injection
