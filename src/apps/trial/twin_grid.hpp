#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "grid_options.hpp"

namespace fleetmap::apps {

/// Runs the grid of cases in the twin, each in a process of its own, as run_grid() does. Cases that run at
/// once share the cores.
CommandResult<ExitCode> run_grid_in_twin(const GridOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
