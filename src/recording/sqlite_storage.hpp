#pragma once

#include "storage_file.hpp"

namespace fleetmap::recording {

/// Makes a .db3 file with the tables of rosbag2 in ROS 2 Humble.
Result<std::unique_ptr<StorageFile>> create_sqlite_storage(const std::filesystem::path& file);

}  // namespace fleetmap::recording
