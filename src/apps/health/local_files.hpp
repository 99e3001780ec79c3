#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// Fails, with the key, if the agent of this configuration could not start with the files of this computer:
/// its folder cannot be made whoever runs it, or the data set of gps.geoid is missing.
Status check_local_files(const agent::AgentConfig& config);

/// A warning if this user cannot write the folder, or make it; the agent may run as another one.
std::optional<std::string> write_warning(const std::filesystem::path& folder);

}  // namespace fleetmap::apps
