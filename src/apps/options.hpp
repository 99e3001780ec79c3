#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// The values of --set.
Result<std::vector<config::Override>> parse_overrides(const std::vector<std::string>& texts);

/// Fails unless `directory` is a folder that files can be made in.
Status check_writable(const std::filesystem::path& directory);
/// The same, and makes it where it is missing.
Status make_writable(const std::filesystem::path& directory);

/// Set by SIGINT and SIGTERM once this was called.
const std::atomic<bool>& stop_on_signals();

}  // namespace fleetmap::apps
