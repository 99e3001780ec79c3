#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "monitor_options.hpp"

namespace fleetmap::apps {

/// Serves the page of a store or a run until a signal comes. Prints its address to `out`.
CommandResult<ExitCode> serve_page(const MonitorOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
