#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/registrations_file.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/store/map_merge.hpp"

namespace fleetmap::run_evaluation {

/// Files of one robot of a run; absent ones are empty.
struct AgentFolder {
  AgentId id;
  std::filesystem::path directory;
  std::optional<output::Trajectory> trajectory, ekf, odometry, truth;
  output::Registrations registrations;
  bool cut_off = false;  ///< it has a store, but neither a map nor a report
};

/// Files that `fleetmap run` wrote into a folder.
struct RunFolder {
  std::filesystem::path directory;
  std::vector<AgentFolder> agents;  ///< by name
  nlohmann::json report;            ///< report.json, or null
  std::vector<std::string> notes;   ///< files that could not be read
};

/// Fails when `directory` holds no robot's folder. `truths` (may be empty) holds NAME.tum or NAME/truth.tum;
/// else each robot's own truth.tum is taken.
Result<RunFolder> open_run(const std::filesystem::path& directory, const std::filesystem::path& truths);

/// Agents that hold the same map.
struct DistinctMap {
  std::vector<AgentId> agents;
  std::filesystem::path file;
  std::string hash;
};
/// Most holders first.
std::vector<DistinctMap> distinct_maps(RunFolder& run);

}  // namespace fleetmap::run_evaluation
