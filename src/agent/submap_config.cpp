#include "fleetmap/agent/submap_config.hpp"

namespace fleetmap::agent {

Status SubmapConfig::validate() const {
  if (!(voxel >= 0.01 && voxel <= 5.0)) return failure("submap voxel must lie in [0.01, 5] m");
  if (!(resolution >= 0.001 && resolution <= voxel))
    return failure("submap resolution must lie in [0.001 m, voxel]");
  if (!(scan_spacing >= 0.0 && scan_angle >= 0.0))
    return failure("submap scan_spacing and scan_angle must be >= 0");
  if (max_bytes < 10'000 || max_bytes > (8u << 20))
    return failure("submap max_bytes must lie in [10000, 8388608]");
  return {};
}

}  // namespace fleetmap::agent
