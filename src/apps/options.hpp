#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// The values of --set.
Result<std::vector<config::Override>> parse_overrides(const std::vector<std::string>& texts);

/// Accepts whole numbers only, checked before the conversion, which would wrap -1 round.
CLI::Validator whole_number(std::uint64_t min, std::uint64_t max = std::numeric_limits<std::uint64_t>::max());
CLI::Validator positive_number();
CLI::Validator non_negative_number();
/// Not empty, as it is when a script's variable is unset.
CLI::Validator some_path();

/// Fails unless `directory` is a folder that files can be made in.
Status check_writable(const std::filesystem::path& directory);
/// The same, and makes it where it is missing.
Status make_writable(const std::filesystem::path& directory);

/// Set by SIGINT and SIGTERM once this was called.
const std::atomic<bool>& stop_on_signals();

}  // namespace fleetmap::apps
