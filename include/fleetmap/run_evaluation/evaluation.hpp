#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "fleetmap/core/result.hpp"
#include "fleetmap/run_evaluation/evaluation_inputs.hpp"

namespace fleetmap::run_evaluation {

/// Measures what a run left in `directory`. Writes evaluation.json, and as asked evaluation.html and
/// map_top.png, map_perspective.png, map_error.png, map_density.png beside it, and puts the numbers into
/// report.json under "evaluation". Values that need a missing truth are left out, with a line in "notes".
///
/// Keys: map (of the map that most robots hold), maps (when they differ), agents.ID, pairs, fleet,
/// alignments, calibration, modes (modes_json()), cpu, links, notes.
Result<nlohmann::json> evaluate_run(const std::filesystem::path& directory, const EvaluationInputs& inputs);

}  // namespace fleetmap::run_evaluation
