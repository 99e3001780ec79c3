#pragma once

#include <filesystem>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::recording {

/// The content of a file; of a .xz file, what it unpacks to. Refuses more than 256 MiB, a scan has a
/// hundredth of it.
Result<Bytes> read_file(const std::filesystem::path& file);

}  // namespace fleetmap::recording
