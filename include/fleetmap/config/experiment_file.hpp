#pragma once

#include <filesystem>

#include "fleetmap/config/experiment_config.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// All problems at once, with file and line; of `base` only that it exists and has agents enough.
Result<ExperimentConfig> load_experiment(const std::filesystem::path& file, bool quick);

}  // namespace fleetmap::config
