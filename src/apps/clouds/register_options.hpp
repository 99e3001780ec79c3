#pragma once

#include <string>
#include <vector>

namespace fleetmap::apps {

/// Two clouds that are registered, as the command line has it.
struct RegisterOptions {
  std::string source;
  std::string target;
  std::vector<double> prior;     ///< x, y, z (m), yaw (deg) of T_target_source; empty: none
  std::vector<double> sigma;     ///< m, deg; empty: the defaults
  std::string config;            ///< AGENT.yaml or FLEET.yaml; empty: defaults
  std::vector<std::string> set;  ///< key=value
};

}  // namespace fleetmap::apps
