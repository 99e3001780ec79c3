#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/eval/map_metrics_config.hpp"
#include "fleetmap/run_evaluation/modes.hpp"

namespace fleetmap::run_evaluation {

/// Truth and options of evaluate_run().
struct EvaluationInputs {
  /// The true surface in ENU of the run's origin; else that of `truth_file`, else that of DIR/truth.ply.
  std::optional<cloud::PointCloud> truth = std::nullopt;
  std::filesystem::path truth_file = {};          ///< a cloud, a mesh or a world
  std::filesystem::path truth_trajectories = {};  ///< NAME.tum or NAME/truth.tum; else DIR/NAME/truth.tum
  eval::MapMetricsConfig map = {};
  double points_per_m2 = 100.0;  ///< of a truth that is sampled from a mesh
  /// A map file with more points is measured at every k-th, so that the map need not fit into memory,
  /// and is compared with no map that would have to be merged again.
  std::size_t max_map_points = 50'000'000;
  bool pictures = true;
  bool page = true;  ///< evaluation.html
  /// Combinations of registration and placement to evaluate beside the run's own, of mode_names().
  std::set<std::string> modes = mode_names();
  bool register_again = false;  ///< in `modes`, by the run's own method too: what this program makes of it
  bool overlap = true;          ///< also measure what two robots saw
};

}  // namespace fleetmap::run_evaluation
