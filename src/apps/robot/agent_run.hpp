#pragma once

#include <iosfwd>

#include "agent_options.hpp"
#include "command_result.hpp"

namespace fleetmap::apps {

/// Runs a robot until it is stopped, then writes its map and report and prints a line on the map to `out`.
CommandResult<ExitCode> run_agent(const AgentOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
