#include "robot_health.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::agent {
namespace {

constexpr Duration kNoScan = std::chrono::seconds(5);
static_assert(messages::Health::kSensors == sensor::kSources);

}  // namespace

HealthCounters counters_of(const Perception& perception, std::uint64_t refused_writes, Stamp begun,
                           Stamp now) {
  HealthCounters counters{.since_scan = now - std::max(perception.last_scan(), begun),
                          .unmatched_scans = perception.odometry_counters().lost,
                          .dropped_scans = perception.counters().dropped_scans,
                          .refused_writes = refused_writes,
                          .located = perception.global_pose().has_value(),
                          .behind = {}};
  for (std::size_t k = 0; k < sensor::kSources; ++k)
    counters.behind[k] = perception.clock_offsets().behind(static_cast<sensor::Source>(k));
  return counters;
}

messages::Health health_of(const HealthCounters& counters) {
  using messages::Health;
  unsigned problems = 0;
  if (counters.since_scan > kNoScan) problems |= Health::kNoScan;
  if (counters.unmatched_scans > 0) problems |= Health::kScansNotMatched;
  if (counters.dropped_scans > 0) problems |= Health::kScansDropped;
  if (counters.refused_writes > 0) problems |= Health::kDiskRefuses;
  if (!counters.located) problems |= Health::kNoPose;
  Health health{static_cast<std::uint8_t>(problems), 0, 0};
  std::optional<double> worst;
  for (std::size_t k = 0; k < counters.behind.size(); ++k) {
    const auto& behind = counters.behind[k];
    if (!behind || (worst && std::abs(*behind) <= std::abs(*worst))) continue;
    worst = behind;
    health.clock_sensor = static_cast<std::uint8_t>(k);
    health.clock_offset = messages::clock_code(*behind);
  }
  return health;
}

}  // namespace fleetmap::agent
