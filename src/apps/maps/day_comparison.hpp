#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "diff_options.hpp"

namespace fleetmap::apps {

/// Prints to `out` what changed between two days, and writes the files that the options name.
CommandResult<ExitCode> compare_days(const DiffOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
