#pragma once

#include <iosfwd>

#include "calibrate_options.hpp"
#include "command_result.hpp"

namespace fleetmap::apps {

/// Runs the odometry by LiDAR alone over a recording, estimates the mounts of LiDAR, IMU and GPS antenna by
/// it, and prints them to `out` beside those in use. kFailed if the odometry lost its way or the drive shows
/// none of them.
CommandResult<ExitCode> calibrate_recording(const CalibrateOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
