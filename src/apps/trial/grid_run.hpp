#pragma once

#include <atomic>
#include <functional>
#include <iosfwd>

#include "command_result.hpp"
#include "fleetmap/experiment/case.hpp"
#include "grid_options.hpp"

namespace fleetmap::apps {

using MakeEngine = std::function<experiment::Engine(const std::atomic<bool>& stop)>;

/// Runs, lists or reports the cases of the file, and prints progress and results to `out`. kFailed while
/// cases are missing or have failed.
CommandResult<ExitCode> run_grid(const GridOptions& options, const MakeEngine& make_engine,
                                 std::ostream& out);

}  // namespace fleetmap::apps
