#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/eval/metrics.hpp"

namespace fleetmap::apps {

/// Names of the combinations of registration and placement, see modes_json().
std::set<std::string> mode_names();

struct EvaluationInputs {
  /// The true surface in ENU of the run's origin; else that of `truth_file`, else that of DIR/truth.ply.
  std::optional<cloud::PointCloud> truth = std::nullopt;
  std::filesystem::path truth_file = {};          ///< a cloud, a mesh or a world
  std::filesystem::path truth_trajectories = {};  ///< NAME.tum or NAME/truth.tum; else DIR/NAME/truth.tum
  eval::MapMetricsConfig map = {};
  double points_per_m2 = 100.0;  ///< of a truth that is sampled from a mesh
  bool pictures = true;
  bool page = true;  ///< evaluation.html
  /// Combinations of registration and placement to evaluate beside the run's own, of mode_names().
  std::set<std::string> modes = mode_names();
  bool register_again = false;  ///< in `modes`, by the run's own method too: what this program makes of it
  bool overlap = true;          ///< also measure what two robots saw
};

/// Measures what a run left in `directory`. Writes evaluation.json, and as asked evaluation.html and
/// map_top.png, map_perspective.png, map_error.png, map_density.png beside it, and puts the numbers into
/// report.json under "evaluation". What a missing truth does not allow is left out and said in "notes".
///
/// Keys: map (of the map that most robots hold), maps (when they differ), agents.ID, pairs, fleet,
/// alignments, calibration, modes (modes_json()), cpu, links, notes.
Result<nlohmann::json> evaluate_run(const std::filesystem::path& directory, const EvaluationInputs& inputs);

}  // namespace fleetmap::apps
