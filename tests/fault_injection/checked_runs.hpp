#pragma once

#include "fleetmap/fault_injection/fleet_run.hpp"

namespace fleetmap::fault_injection {

/// A run that checks these invariants ("all", or their names).
inline RunConfig checking(const char* invariants) {
  RunConfig config;
  config.invariants = parse_invariants(invariants).value();
  return config;
}

}  // namespace fleetmap::fault_injection
