#pragma once

#include <iosfwd>
#include <string>

#include "command_result.hpp"
#include "trial_options.hpp"

namespace fleetmap::apps {

/// The script of the source tree that the program was built in, else that of the package.
std::string field_script();

/// Runs the grid of cases in network namespaces, as run_grid() does.
CommandResult<ExitCode> run_trial(TrialOptions options, std::ostream& out);

}  // namespace fleetmap::apps
