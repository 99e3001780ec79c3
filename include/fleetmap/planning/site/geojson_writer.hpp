#pragma once

#include <filesystem>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/site/file_frame.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Reading it again gives the same mission to a micrometre (ENU) or 0.1 mm (WGS84; 9 decimals of a degree).
std::string to_geojson(const Mission& mission, const LocalFrame& site, FileFrame frame = FileFrame::kWgs84);
Status write_geojson(const std::filesystem::path& file, const Mission& mission, const LocalFrame& site,
                     FileFrame frame = FileFrame::kWgs84);

}  // namespace fleetmap::planning
