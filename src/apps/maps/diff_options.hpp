#pragma once

#include <string>

namespace fleetmap::apps {

/// Two days that are compared, as the command line has them.
struct DiffOptions {
  std::string before, after;  ///< stores
  std::string geojson, ply;   ///< files; empty: not written
};

}  // namespace fleetmap::apps
