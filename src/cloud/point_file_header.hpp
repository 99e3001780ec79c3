#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Fails, without naming the file, where the header is malformed or promises more points than the file has
/// bytes for.
Status check_pcd_header(const std::filesystem::path& file);
Status check_ply_header(const std::filesystem::path& file);

}  // namespace fleetmap::cloud
