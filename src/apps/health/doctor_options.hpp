#pragma once

#include <string>
#include <vector>

namespace fleetmap::apps {

/// An examination of a robot's sensors, as the command line has it.
struct DoctorOptions {
  std::string config;            ///< AGENT.yaml
  double seconds = 30.0;         ///< to listen
  std::vector<std::string> set;  ///< key=value
};

}  // namespace fleetmap::apps
