#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "fleetmap/agent/perception.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/health.hpp"
#include "fleetmap/sensor/clock_offsets.hpp"

namespace fleetmap::agent {

/// A robot's counters from which its health follows.
struct HealthCounters {
  Duration since_scan{};  ///< since the last scan, or the start
  std::uint64_t unmatched_scans = 0;
  std::uint64_t dropped_scans = 0;
  std::uint64_t refused_writes = 0;
  bool located = false;                                          ///< G is known
  std::array<std::optional<double>, sensor::kSources> behind{};  ///< s, of each sensor's clock
};

/// `begun`: the start of the program, from which a missing first scan counts.
HealthCounters counters_of(const Perception& perception, std::uint64_t refused_writes, Stamp begun,
                           Stamp now);

messages::Health health_of(const HealthCounters& counters);

}  // namespace fleetmap::agent
