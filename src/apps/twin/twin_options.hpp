#pragma once

#include <string>
#include <vector>

namespace fleetmap::apps {

/// The digital twin in real time, as the command line has it.
struct TwinOptions {
  std::string config;            ///< FLEET.yaml with a world
  std::string out;               ///< folder of the truth; empty: it is not written
  double duration = 0.0;         ///< s; 0: until a signal
  std::vector<std::string> set;  ///< key=value
};

}  // namespace fleetmap::apps
