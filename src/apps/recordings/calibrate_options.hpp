#pragma once

#include "recording_options.hpp"

namespace fleetmap::apps {

/// Calibration of a robot's mounts by a recorded drive, as the command line has it.
struct CalibrateOptions {
  RecordingOptions input;
  bool json = false;
};

}  // namespace fleetmap::apps
