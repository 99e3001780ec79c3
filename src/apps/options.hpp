#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// The values of --set.
Result<std::vector<config::Override>> parse_overrides(const std::vector<std::string>& texts);

/// Set by SIGINT and SIGTERM once this was called.
const std::atomic<bool>& stop_on_signals();

}  // namespace fleetmap::apps
