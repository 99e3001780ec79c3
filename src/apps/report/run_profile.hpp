#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/virtual_fleet.hpp"

namespace fleetmap::apps {

/// The cost of a run in one process: CPU seconds of all threads by what they were spent on, and wall time.
struct RunProfile {
  FeedSeconds feed;
  agent::WorkSeconds work;
  double results = 0.0;  ///< final placements and maps
  double set_up = 0.0;   ///< before the first event: world, tree of its triangles, true cloud
  double cpu = 0.0;      ///< of the whole process
  double wall = 0.0;
  double virtual_time = 0.0;

  /// Wire messages, exchange, filters, submaps, planning, bookkeeping: all that has no entry of its own.
  double rest() const;
};

/// `cpu_before` and `cpu` are process_cpu_seconds() at the first event and now.
RunProfile profile_of(const FleetOutcome& outcome, double cpu_before, double cpu, double wall_seconds);

/// `profile` of report.json: seconds (`*_s`), and `shares` of the CPU that add up to 1.
nlohmann::json to_json(const RunProfile& profile);
/// Two lines for a person.
std::string summary_of(const RunProfile& profile);

}  // namespace fleetmap::apps
