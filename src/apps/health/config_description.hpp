#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// Checks any of the program's YAML files as the program would use it: worlds are built, missions planned.
/// `agents`: only the first so many of a fleet. Returns what the file is ("a valid sensor"); warnings go to
/// standard error. Fails with file:line of the first mistake.
Result<std::string> describe_config(const std::string& file, const std::vector<config::Override>& overrides,
                                    const std::optional<std::size_t>& agents);

}  // namespace fleetmap::apps
