#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/monitor/live_status.hpp"

namespace fleetmap::apps {

/// Rates at which a robot's sensors send.
class SensorRates {
 public:
  /// All of them, with the rates since the last call; 0 at the first one. To be called every second.
  std::vector<monitor::SensorNow> add(const agent::Perception& perception, Stamp now);

 private:
  std::array<std::uint64_t, sensor::kSources> samples_{};     ///< at the last call
  std::array<std::optional<Stamp>, sensor::kSources> heard_;  ///< the call that found a new sample
  std::optional<Stamp> last_;
};

}  // namespace fleetmap::apps
