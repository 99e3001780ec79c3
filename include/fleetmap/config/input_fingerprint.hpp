#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// A hash of what a run of `fleet_file` with `overrides` reads: that file and every file that it names, and
/// those that they name. Folders and files above 64 MB count by names, sizes and times of change.
Result<std::string> input_fingerprint(const std::filesystem::path& fleet_file,
                                      const std::vector<Override>& overrides);

}  // namespace fleetmap::config
