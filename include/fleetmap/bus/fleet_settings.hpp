#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fleetmap::bus {

/// Settings that all robots of a fleet must share. Every Hello carries them; differences are logged, and the
/// robots go on.
struct FleetSettings {
  std::uint8_t wire_schema = 0;    ///< version of the fleet's messages, > 0
  std::uint32_t fleet = 0;         ///< hash of the names of all robots, sorted
  std::uint16_t submap_voxel = 0;  ///< 0.1 mm, edge of the voxels that submaps are thinned to
  std::uint16_t map_voxel = 0;     ///< 0.1 mm, edge of the merged map's voxels
  std::uint16_t placement = 0;     ///< hash of what decides where nodes are placed: site origin, method
  bool operator==(const FleetSettings&) const = default;
};

/// A sentence for each setting in which the robot `name` differs from this one.
std::vector<std::string> differences(const std::string& name, const FleetSettings& theirs,
                                     const FleetSettings& ours);

}  // namespace fleetmap::bus
