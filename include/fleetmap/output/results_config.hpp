#pragma once

#include <filesystem>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/output/recipe_config.hpp"

namespace fleetmap::output {

/// Inputs of an agent's results, beside its store.
struct ResultsConfig {
  AgentId agent;
  std::filesystem::path directory;  ///< holds the agent's trajectories, and gets the results
  RecipeConfig recipe;
};

}  // namespace fleetmap::output
