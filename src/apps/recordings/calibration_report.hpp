#pragma once

#include <iosfwd>

#include "calibrated_mounts.hpp"

namespace fleetmap::apps {

/// A sentence on each number and the mounts as lines of a robot's configuration.
void print_calibration(std::ostream& out, const CalibratedMounts& mounts);
/// The same for programs, with covariances.
void print_calibration_json(std::ostream& out, const CalibratedMounts& mounts);

}  // namespace fleetmap::apps
