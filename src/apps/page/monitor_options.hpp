#pragma once

#include <string>
#include <vector>

#include "monitor_access.hpp"

namespace fleetmap::apps {

/// A run that is shown in a browser, as the command line has it.
struct MonitorOptions {
  std::string store, run;  ///< one of both
  std::string robot;       ///< of a run: whose map is shown; empty: of the one that holds most
  std::vector<std::string> without;
  AccessOptions access;
};

}  // namespace fleetmap::apps
