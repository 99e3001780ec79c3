#pragma once

#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"

namespace fleetmap::config {

/// The settings of a mission alone, from overrides of `mission.*`.
Result<planning::MissionConfig> load_mission_settings(const std::vector<Override>& overrides);

}  // namespace fleetmap::config
