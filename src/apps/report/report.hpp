#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/stall_detector.hpp"
#include "fleetmap/output/results.hpp"
#include "run_profile.hpp"
#include "twin/virtual_fleet.hpp"

namespace fleetmap::apps {

/// A sentence for the last lines of a run; empty if every scan fitted the local map.
std::string lost_ways(const odometry::LoamCounters& odometry);

/// The program and its settings, as a report names them.
struct RunSettings {
  std::string version;
  std::string configuration;     ///< file, or the recordings
  std::vector<std::string> set;  ///< key=value
};
/// report.json and report.html of a fleet's run. Sizes in bytes, times in seconds.
Status write_report(const std::filesystem::path& out, const FleetOutcome& outcome, const RunProfile& profile,
                    const RunSettings& settings);
/// Access to the radios.
struct RadioAccess {
  bool keys = false;                            ///< else anyone
  std::vector<std::string> refused;             ///< sentences on who is not exchanged with and why
  std::vector<std::string> different_settings;  ///< sentences on settings of others that must be equal
};
/// One start of an agent, from its beginning to its end.
struct AgentStart {
  RadioAccess access;
  std::vector<bus::StallCounters> stalls;  ///< of its bus's threads
  Duration uptime{};
};
/// The words for it in report.json and on the monitor's page.
const char* who_may_join(bool keys);
/// report.json and report.html of one agent alone, in its folder; `results` may state why it has no map.
Status write_report(const agent::Agent& agent, const Result<output::Results>& results,
                    const AgentStart& start, const RunSettings& settings);

}  // namespace fleetmap::apps
