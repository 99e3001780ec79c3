#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "twin_options.hpp"

namespace fleetmap::apps {

/// Runs the robots of the twin over DDS in real time, until a signal or for the duration. Prints to `out` how
/// far each drove, and writes the drawing of the site, true trajectories and true surfaces.
CommandResult<ExitCode> run_twin(const TwinOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
