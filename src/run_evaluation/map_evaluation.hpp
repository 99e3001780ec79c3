#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/eval/alignment_errors.hpp"
#include "fleetmap/run_evaluation/evaluation_inputs.hpp"
#include "fleetmap/run_evaluation/map_pictures.hpp"
#include "overlap_evaluation.hpp"
#include "run_folder.hpp"
#include "stored_fleet.hpp"

namespace fleetmap::run_evaluation {

/// Measures maps of one run against the truth, if there is one, and draws the first of them.
class MapEvaluation {
 public:
  /// `nodes`, where the nodes truly were, must outlive this.
  MapEvaluation(const EvaluationInputs& inputs, std::optional<cloud::PointCloud> truth,
                const eval::TruePoses& nodes)
      : inputs_(inputs), truth_(std::move(truth)), nodes_(nodes) {}

  /// "map" (of the map that most robots hold) and, where they differ, "maps".
  Status add_to(nlohmann::json& evaluation, const std::vector<DistinctMap>& maps, StoredFleet* held);
  /// The map of what is held as it is placed now, without pictures. Call it with one `held` only.
  nlohmann::json of_held(StoredFleet& held);

  /// A map had more points than EvaluationInputs::max_map_points.
  bool thinned() const { return thinned_; }

  std::vector<MapPicture> pictures;
  std::vector<std::string> notes;

 private:
  nlohmann::json evaluate(const cloud::PointCloud& map, const std::string& name, StoredFleet* held,
                          bool draw);
  void draw_by_robot(const cloud::PointCloud& cloud, StoredFleet* held);
  void keep(Result<MapPicture> picture);

  const EvaluationInputs& inputs_;
  std::optional<cloud::PointCloud> truth_;
  const eval::TruePoses& nodes_;
  bool thinned_ = false;
  Pose start_ = Pose::Identity();             ///< T_truth_map that registrations start from
  std::optional<OverlapEvaluation> overlap_;  ///< made when first needed
};

}  // namespace fleetmap::run_evaluation
