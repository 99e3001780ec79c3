#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleetmap/fault_injection/fleet_run.hpp"

namespace fleetmap::fault_injection {

/// The seed's scenario with these of its faults alone.
Scenario with_faults(Scenario scenario, const std::vector<std::size_t>& kept);

/// Reports the failed invariants and, if `shrinks`, the fewest faults that still fail, with the command that
/// replays them.
std::string failure_report(const Scenario& scenario, const Outcome& outcome, const RunConfig& config,
                           bool shrinks);

}  // namespace fleetmap::fault_injection
