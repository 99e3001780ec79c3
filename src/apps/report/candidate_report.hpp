#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/monitor/pair_candidates.hpp"

namespace fleetmap::apps {

/// The candidates of a robot with each other one of its fleet, by its own count.
std::vector<monitor::PairCandidates> candidates_of(const agent::Agent& agent);

/// The same for report.json, by the other robot.
nlohmann::json candidates_json(const std::vector<monitor::PairCandidates>& candidates);

/// Those in a report of `run` or of the agent `self`, as they were when the robots ended. Empty where it is
/// of an older program or is none.
std::vector<monitor::PairCandidates> reported_candidates(const nlohmann::json& report, const AgentId& self);

}  // namespace fleetmap::apps
