#include "fleetmap/bus/fleet_settings.hpp"

#include <iomanip>
#include <sstream>

namespace fleetmap::bus {
namespace {

std::string metres(std::uint16_t tenths_of_mm) {
  const int digits = tenths_of_mm % 100 == 0 ? 2 : 4;
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << tenths_of_mm * 1e-4 << " m";
  return text.str();
}

}  // namespace

std::vector<std::string> differences(const std::string& name, const FleetSettings& theirs,
                                     const FleetSettings& ours) {
  std::vector<std::string> all;
  if (theirs.wire_schema != ours.wire_schema) {
    all.push_back(name + " sends messages of version " + std::to_string(theirs.wire_schema) + ", ours are " +
                  std::to_string(ours.wire_schema) +
                  ": each refuses the other's; install the same fleetmap on both");
  }
  if (theirs.fleet != ours.fleet)
    all.push_back(name + "'s fleet list is another: `fleet` must name the same robots in every file");
  if (theirs.submap_voxel != ours.submap_voxel) {
    all.push_back(name + "'s submaps have voxels of " + metres(theirs.submap_voxel) + ", ours " +
                  metres(ours.submap_voxel) +
                  ": parts of the map will be finer than others; set submap.voxel alike");
  }
  if (theirs.map_voxel != ours.map_voxel) {
    all.push_back(name + "'s map has voxels of " + metres(theirs.map_voxel) + ", ours " +
                  metres(ours.map_voxel) + ": the maps will differ; set map.voxel alike");
  }
  if (theirs.placement != ours.placement) {
    all.push_back(name +
                  " places nodes by other settings: the maps will differ; set site.origin, placement and "
                  "gps.correlation_time alike");
  }
  return all;
}

}  // namespace fleetmap::bus
