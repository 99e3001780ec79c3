#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/fault_injection/invariant.hpp"
#include "fleetmap/fault_injection/run_config.hpp"
#include "fleetmap/fault_injection/scenario.hpp"

namespace fleetmap::fault_injection {

/// Result of one simulated fleet.
struct Outcome {
  std::vector<Violation> violations;  ///< the first of each invariant and robot
  Duration converged_after{};         ///< the last fault
  double max_bytes_per_second = 0.0;  ///< of all robots on the radio
  double largest_error = 0.0;         ///< m, of an honest robot's node at the end
  double torn = 0.0;  ///< m, by which a compromised robot displaced honest nodes against each other
  std::size_t nodes = 0, alignments = 0;
  std::uint64_t packets = 0;
  std::uint64_t fingerprint = 0;  ///< of every packet: equal runs have equal ones
  std::vector<std::string> trace;
};

/// The fleet of the scenario, from its start until it has converged or may no longer.
Outcome run(const Scenario& scenario, const RunConfig& config);

}  // namespace fleetmap::fault_injection
