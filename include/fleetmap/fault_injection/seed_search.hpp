#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "fleetmap/fault_injection/run_config.hpp"
#include "fleetmap/fault_injection/scenario_config.hpp"

namespace fleetmap::fault_injection {

/// Seeds from `first` on, `count` of them, `jobs` at a time.
struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t count = 100;
  unsigned jobs = 1;
  bool shrinks = true;  ///< a failed seed is searched for the fewest faults that still fail
};

/// Sums over the runs of all seeds.
struct SeedTotals {
  std::size_t failed = 0;
  double longest_s = 0.0;  ///< until convergence
  double max_bytes_per_second = 0.0;
  std::size_t nodes = 0, packets = 0;
};

/// Runs the scenario of each seed and calls `on_failure` with the report of each one that violates an
/// invariant: from any thread, but one call at a time. Totals do not depend on `jobs`.
SeedTotals try_seeds(const SeedRange& seeds, const ScenarioConfig& scenarios, const RunConfig& config,
                     const std::function<void(const std::string&)>& on_failure);

}  // namespace fleetmap::fault_injection
