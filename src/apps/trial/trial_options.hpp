#pragma once

#include <string>

#include "grid_options.hpp"

namespace fleetmap::apps {

/// A trial of robots in network namespaces, as the command line has it.
struct TrialOptions {
  GridOptions grid;
  std::string traces;  ///< CSV of links; empty: none
  std::string script;  ///< field.sh
};

}  // namespace fleetmap::apps
