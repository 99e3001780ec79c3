#pragma once

#include <string>

#include "recording_options.hpp"

namespace fleetmap::apps {

/// Odometry alone, as the command line has it.
struct OdometryOptions {
  RecordingOptions input;
  std::string out;  ///< TUM file
};

}  // namespace fleetmap::apps
