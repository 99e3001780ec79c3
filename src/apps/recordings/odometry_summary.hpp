#pragma once

#include <ostream>

#include "odometry_run.hpp"

namespace fleetmap::apps {

/// Scans, time and memory, a line each.
void print_summary(std::ostream& out, const OdometryRun& run);
/// Prints why the trajectory is less reliable.
void print_losses(std::ostream& out, const OdometryRun& run);

}  // namespace fleetmap::apps
