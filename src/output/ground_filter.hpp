#pragma once

#include <vector>

#include "fleetmap/output/elevation_config.hpp"

namespace fleetmap::output {

/// Cells of a raster whose lowest points are the ground's. `low`: m, height of the lowest points of each
/// cell, row by row, NaN where there is none. The progressive morphological filter of Zhang et al. 2003 ("A
/// progressive morphological filter for removing nonground measurements from airborne lidar data", IEEE TGRS
/// 41(4)) with windows that double; cells without points take no part. Before it, single cells far below
/// their neighbours (reflections) are left out.
std::vector<bool> ground_cells(std::vector<float> low, int width, const ElevationConfig& config);

}  // namespace fleetmap::output
