#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/las_map_config.hpp"
#include "fleetmap/output/map_crs.hpp"
#include "fleetmap/store/store.hpp"
#include "fleetmap/store/tiled_merge.hpp"

namespace fleetmap::output {

/// Numbers of points and files that were written.
struct WrittenLas {
  store::MapOutline outline;
  std::uint64_t points = 0;
  std::uint64_t left_out = 0;  ///< not finite, or too far away
  std::size_t files = 0;
};

/// Merges the map of those nodes whose submaps the store holds, tile by tile, into one LAS file or a folder
/// of them (cloud::LasWriter, cloud::LasTiles), in memory that does not grow with the map. All in the headers
/// is of the map, so that the same map gives the same bytes: the GUID is its hash, the day that of its newest
/// node. Point source IDs are the robots that were first to see a voxel, from 1, which the text area names.
Result<WrittenLas> write_las(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                             const store::MergeConfig& merge, const MapCrs& crs, const LasMapConfig& config);

/// Factor that brings a device's intensities to 16 bits, by the greatest of the map: devices send fractions,
/// 8 bits or 16 bits.
double las_intensity_gain(float max_intensity);

}  // namespace fleetmap::output
