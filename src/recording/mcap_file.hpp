#pragma once

#include "bag_file.hpp"

namespace fleetmap::recording {

/// A file of rosbag2's mcap storage: chunks plain, lz4 or zstd, or no chunks. A file that was cut is read as
/// far as it goes, and a damaged chunk is left out; both are logged.
Result<std::unique_ptr<BagFile>> open_mcap_file(const std::filesystem::path& file);

}  // namespace fleetmap::recording
