#pragma once

#include "storage_file.hpp"

namespace fleetmap::recording {

/// Makes an .mcap file as rosbag2_storage_mcap does: profile "ros2", types as "ros2msg", a chunk for what was
/// written between two calls of flush(), which bound its size.
Result<std::unique_ptr<StorageFile>> create_mcap_storage(const std::filesystem::path& file,
                                                         ChunkCompression compression);

}  // namespace fleetmap::recording
