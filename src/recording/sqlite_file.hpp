#pragma once

#include "bag_file.hpp"

namespace fleetmap::recording {

/// A database file of rosbag2's sqlite3 storage.
Result<std::unique_ptr<BagFile>> open_sqlite_file(const std::filesystem::path& file);

}  // namespace fleetmap::recording
