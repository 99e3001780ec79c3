#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "fuzz_options.hpp"

namespace fleetmap::apps {

/// Simulates the fleets of many seeds and prints those that violate an invariant, or replays one seed and
/// prints what happens in it. kFailed if any invariant is violated.
CommandResult<ExitCode> search_faults(const FuzzOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
