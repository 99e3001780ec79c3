#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "merge_options.hpp"

namespace fleetmap::apps {

/// Merges stores of several days or robots, and prints to `out` what each of them added.
CommandResult<ExitCode> merge_files(const MergeOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
