#pragma once

#include <nlohmann/json.hpp>

#include "map_evaluation.hpp"

namespace fleetmap::run_evaluation {

/// The map that each of modes() makes of one run's nodes and loop candidates, so that their difference shows
/// what each method is worth. The method that the run did not use registers the same pairs of the same clouds
/// again (RegistrationLog); if asked for (`EvaluationInputs::register_again`) the run's own method too. Each
/// has "fleet", "alignments" and "map" as in the evaluation itself; those of the graph also the status of the
/// alignments and the NEES of placed nodes. Where that is how the run was made, `evaluation` is copied.
/// Combinations whose registrations were not logged are left out, with a note. Only those named in
/// `inputs.modes` are made. Null without truth.
nlohmann::json modes_json(RunFolder& run, StoredFleet& held, const eval::TruePoses& nodes,
                          MapEvaluation& maps, const nlohmann::json& evaluation,
                          const EvaluationInputs& inputs);

}  // namespace fleetmap::run_evaluation
