#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/elevation_config.hpp"
#include "fleetmap/output/map_crs.hpp"
#include "fleetmap/store/store.hpp"
#include "fleetmap/store/tiled_merge.hpp"

namespace fleetmap::output {

/// Size and coverage of the rasters that were written.
struct WrittenElevation {
  store::MapOutline outline;
  int width = 0, height = 0;  ///< cells
  std::size_t observed = 0;   ///< cells with points
  std::size_t ground = 0;     ///< cells in which the ground was seen
};

/// Merges the map of those nodes whose submaps the store holds, tile by tile, into three GeoTIFFs in the new
/// folder `out`, which appears whole or not at all: ground.tif (terrain, DTM), surface.tif (the highest
/// points, DSM) and hillshade.tif (of the surface). Cells without points are NoData. `software` writes it.
/// Once `stop` is set it ends early with an error.
Result<WrittenElevation> write_elevation(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                                         const store::MergeConfig& merge, const MapCrs& crs,
                                         const ElevationConfig& config, const std::filesystem::path& out,
                                         const std::string& software, const std::atomic<bool>& stop);

}  // namespace fleetmap::output
