#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

#include "fleetmap/config/experiment_config.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/experiment/case.hpp"

namespace fleetmap::experiment {

/// An experiment's file and the cases that it stands for.
struct Grid {
  config::ExperimentConfig config;
  std::vector<Case> cases;
};

/// Reads the file (`quick`: its quick set) with `overrides` for every study. Fails if the inputs of a case
/// cannot be read: this is found before hours are spent on the others.
Result<Grid> load_grid(const std::filesystem::path& file, bool quick,
                       const std::vector<config::Override>& overrides);

/// Prints a line a case; those whose run an earlier line has are marked.
Status list_cases(const std::vector<Case>& cases, std::ostream& out);

}  // namespace fleetmap::experiment
