#pragma once

#include <filesystem>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// Kind of a configuration file.
enum class FileKind { kRobot, kFleet, kWorld, kSensor, kExperiment };
/// Loads `file` as the kind that its keys show: agents, studies, kind, a LiDAR's pattern, or else one
/// robot's. Worlds are not built and fleets not planned. Overrides are for robots and fleets only.
Result<FileKind> check(const std::filesystem::path& file, const std::vector<Override>& overrides);

}  // namespace fleetmap::config
