#pragma once

#include <cstdint>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// Bounds and durability of a store.
struct StoreConfig {
  std::uint32_t max_submap_bytes = 8u << 20;  ///< bytes, nodes that announce a larger submap are refused
  /// Own items and named values survive a power cut as soon as they are put (one disk sync each), and all
  /// else after Store::sync(). Without it SQLite syncs its checkpoints alone.
  bool power_safe = true;
  std::string file_system;  ///< name of the SQLite VFS that holds the file; empty: the system's own
  Status validate() const;
};

}  // namespace fleetmap::store
