#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "odometry_options.hpp"

namespace fleetmap::apps {

/// Runs the odometry over a recording, writes the trajectory and prints scans, time, memory and losses to
/// `out`. Fails, after that, if the odometry lost its way or parts of the recording are damaged.
CommandResult<ExitCode> trace_recording(const OdometryOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
