#pragma once

#include <optional>
#include <string>
#include <vector>

#include "las_options.hpp"

namespace fleetmap::apps {

/// A store whose map is shown or written, as the command line has it.
struct MapOptions {
  std::string store;
  std::string out;                   ///< file or folder
  std::optional<double> voxel;       ///< m; else as in the agent's last map
  std::vector<double> origin_deg;    ///< latitude, longitude, altitude (m); empty: that of the last map
  std::vector<std::string> without;  ///< robots that are left out
  bool json = false;                 ///< of info
  LasOptions las;
  std::string format;            ///< "geotiff", or empty: by the name of `out`
  std::optional<double> cell_m;  ///< of GeoTIFF
};

}  // namespace fleetmap::apps
