#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::apps {

/// The files that a robot left, or those of a whole run.
struct RobotFiles {
  AgentId robot;
  std::filesystem::path folder, store;
};

/// report.json in the folder. Null where there is none, where it cannot be read, or where it is of a run
/// before that which wrote the store.
nlohmann::json report_of(const RobotFiles& files);

}  // namespace fleetmap::apps
