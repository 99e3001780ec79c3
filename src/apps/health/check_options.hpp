#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "network_check_options.hpp"

namespace fleetmap::apps {

/// A file that is checked, as the command line has it.
struct CheckOptions {
  std::string file;
  std::vector<std::string> set;       ///< key=value
  std::optional<std::size_t> agents;  ///< the first so many of a fleet
  bool network = false;               ///< listens on the radios of the robot
  NetworkCheckOptions radios;
};

}  // namespace fleetmap::apps
