#pragma once

#include <cstddef>
#include <set>

#include "fleetmap/core/time.hpp"
#include "fleetmap/fault_injection/fault.hpp"

namespace fleetmap::fault_injection {

/// Ranges from which a seed draws a fleet and its faults.
struct ScenarioConfig {
  std::size_t min_robots = 3, max_robots = 10;
  Duration mapping = std::chrono::seconds(150);
  std::size_t max_faults = 12;
  std::set<FaultKind> kinds;
};

}  // namespace fleetmap::fault_injection
