#pragma once

#include <string>
#include <vector>

namespace fleetmap::apps {

/// A recording that is played onto a robot's onboard domain, as the command line has it.
struct ReplayOptions {
  std::string recording;          ///< empty: that of the file
  std::string config;             ///< AGENT.yaml; empty: defaults
  std::string as;                 ///< the robot's name; empty: that of the file
  double rate = 1.0;              ///< times real time
  double wait_for_reader = 30.0;  ///< s, for an agent that listens
  std::vector<std::string> set;   ///< key=value
};

}  // namespace fleetmap::apps
