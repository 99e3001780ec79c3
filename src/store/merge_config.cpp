#include "fleetmap/store/merge_config.hpp"

#include <limits>

namespace fleetmap::store {

Status MergeConfig::validate() const {
  // The grid's edge is a float.
  using Float = std::numeric_limits<float>;
  if (!(voxel_m >= double{Float::min()} && voxel_m <= double{Float::max()}))
    return failure("merge.voxel_m must be positive");
  return {};
}

}  // namespace fleetmap::store
