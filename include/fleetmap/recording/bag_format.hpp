#pragma once

#include <cstdint>

namespace fleetmap::recording {

/// Storage of a rosbag2 bag: MCAP is the default of ROS 2 since Iron, SQLite that of Humble.
enum class BagStorage : std::uint8_t { kMcap, kSqlite };
enum class ChunkCompression : std::uint8_t { kZstd, kLz4, kNone };

struct BagFormat {
  BagStorage storage = BagStorage::kMcap;
  ChunkCompression compression = ChunkCompression::kZstd;  ///< of MCAP
};

/// A late subscriber of a transient local topic receives the last message, as of /tf_static.
enum class Durability : std::uint8_t { kTransientLocal, kVolatile };

}  // namespace fleetmap::recording
