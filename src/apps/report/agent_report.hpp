#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fleetmap/agent/agent.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::apps {

/// One agent's part of report.json: what it received, made, sent and refused.
nlohmann::json agent_report(const agent::Agent& agent, const output::Results* results);

/// Adds what the agent holds, and the map that was made of it.
void add_holdings(nlohmann::json& report, const store::Store& store, const output::Results* results);

nlohmann::json origin_json(const GeoPoint& origin);

}  // namespace fleetmap::apps
