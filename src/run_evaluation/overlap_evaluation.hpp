#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/eval/alignment_errors.hpp"
#include "fleetmap/eval/map_metrics_config.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::run_evaluation {

/// The part of the map that at least two robots saw. A place counts as seen by a robot by where its submaps
/// truly lie, so misplaced points count against the map.
class OverlapEvaluation {
 public:
  /// `surface` is the site. All must outlive this.
  OverlapEvaluation(store::Store& store, const store::MergeConfig& merge, const eval::TruePoses& truth,
                    const cloud::PointCloud& surface, const eval::MapMetricsConfig& config);
  ~OverlapEvaluation();

  /// With the nodes at `T_enu_node`, registered as the whole map is; null where nothing was seen twice.
  nlohmann::json of(const std::map<NodeId, Pose>& T_enu_node, const Pose& T_truth_map) const;

 private:
  class TrueSubmaps;
  std::unique_ptr<TrueSubmaps> submaps_;
  const eval::TruePoses& truth_;
  const eval::MapMetricsConfig& config_;
  cloud::PointCloud shared_;  ///< the site, where two robots saw it
  nlohmann::json limit_;      ///< every node at its true place: what sensors and submaps allow
};

}  // namespace fleetmap::run_evaluation
