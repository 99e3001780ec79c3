#include "fleetmap/store/store_config.hpp"

namespace fleetmap::store {

Status StoreConfig::validate() const {
  if (max_submap_bytes == 0 || max_submap_bytes > (1u << 30)) {
    return failure("store.max_submap_bytes must be in 1 .. 2^30");
  }
  return {};
}

}  // namespace fleetmap::store
