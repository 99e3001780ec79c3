#pragma once

#include <nlohmann/json.hpp>

#include "map_evaluation.hpp"

namespace fleetmap::apps {

/// "paper" and "fleet": the same nodes and alignments as each mode places them, so that one run tells both.
/// Of each: fleet, alignments and map as in the evaluation itself; of mode fleet also what became of the
/// alignments, and how its covariances keep to the truth. Where that is how the run placed them already,
/// `evaluation` gives what it has. Null without truth.
nlohmann::json modes_json(const RunFolder& run, HeldFleet& held, const eval::TruePoses& nodes,
                          MapEvaluation& maps, const nlohmann::json& evaluation);

}  // namespace fleetmap::apps
