#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/fault_injection/fault.hpp"
#include "fleetmap/fault_injection/scenario_config.hpp"

namespace fleetmap::fault_injection {

/// A fleet, how long it maps, and what goes wrong meanwhile.
struct Scenario {
  std::uint64_t seed = 0;  ///< of all that is random within
  std::size_t robots = 3;
  Duration mapping{};
  std::vector<Fault> faults;  ///< by their begin
};

Scenario make_scenario(std::uint64_t seed, const ScenarioConfig& config);

}  // namespace fleetmap::fault_injection
