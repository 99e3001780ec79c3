#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "run_options.hpp"

namespace fleetmap::apps {

/// Runs the fleet, writes maps, trajectories, the twin's truth and the report, and prints a summary to `out`.
/// kFailed if an agent has no results, or its recording is damaged or could not be read to its end.
CommandResult<ExitCode> run_fleet(const RunOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
