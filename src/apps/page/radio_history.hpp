#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "fleetmap/monitor/radio_history.hpp"
#include "fleetmap/output/link_trace.hpp"

namespace fleetmap::apps {

/// Messages that the robots heard in their last mission, in at most 900 steps of equal length: the rows after
/// the last hour in which none logged anything, in any order. Has no kinds, traces and reports.
monitor::RadioHistory radio_history(std::vector<output::LinkTraceRow> rows);

/// Adds the kinds of messages in the report of robot `by`, or of a whole run, and whose these are.
void add_radio_use(const nlohmann::json& report, const AgentId& by, monitor::RadioHistory& history);

}  // namespace fleetmap::apps
