#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "plan_options.hpp"

namespace fleetmap::apps {

/// Divides the rows of a drawing among robots, prints the plan to `out` and writes it as GeoJSON with a
/// picture beside.
CommandResult<ExitCode> plan_site(const PlanOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
