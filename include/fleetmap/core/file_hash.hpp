#pragma once

#include <filesystem>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap {

/// content_hash() of a file's bytes, read block by block. The error names the file.
Result<ContentHash> file_hash(const std::filesystem::path& file);

}  // namespace fleetmap
