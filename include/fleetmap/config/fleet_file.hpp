#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// Agents' directories are left empty. Robots over DDS get domains of their own, counted from
/// dds.base_domain.
Result<FleetConfig> load_fleet(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// A fleet with default settings (VLP-16), one agent a recording.
Result<FleetConfig> fleet_of(const std::vector<std::pair<AgentId, std::filesystem::path>>& recordings,
                             const std::vector<Override>& overrides);

}  // namespace fleetmap::config
