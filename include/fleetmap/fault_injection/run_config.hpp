#pragma once

#include <filesystem>
#include <set>

#include "fleetmap/core/time.hpp"
#include "fleetmap/fault_injection/invariant.hpp"

namespace fleetmap::fault_injection {

/// Settings of a simulated fleet that its scenario does not contain.
struct RunConfig {
  /// s after the last fault, in which all must have converged.
  Duration convergence_timeout = std::chrono::minutes(10);
  std::set<Invariant> invariants;  ///< that are checked
  bool trace = false;
  /// Robots sign their items, forged items bear wrong signatures, and a liar alters items of others that it
  /// hands over.
  bool signatures = false;
  /// Existing folder that keeps the robots' stores; empty: they are deleted.
  std::filesystem::path stores = {};
};

}  // namespace fleetmap::fault_injection
