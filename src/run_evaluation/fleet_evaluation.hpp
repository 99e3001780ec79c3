#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "fleetmap/eval/alignment_errors.hpp"
#include "run_folder.hpp"
#include "stored_fleet.hpp"

namespace fleetmap::run_evaluation {

/// True poses of the nodes, from the true trajectories at their stamps.
eval::TruePoses true_poses(const RunFolder& run, const store::Store& store);

/// NEES and what else eval::Consistency tells.
nlohmann::json consistency_json(std::span<const eval::StatedError> errors);

/// Right and wrong alignments, how large their errors are, and whether their covariances tell.
nlohmann::json alignments_json(const RunFolder& run, const StoredFleet& held, const eval::TruePoses& truth);

/// Errors of all robots together, and between them; null without truth.
nlohmann::json fleet_json(const RunFolder& run, const StoredFleet* held, const eval::TruePoses& truth);

/// Normalised errors (NEES) of everything that states a covariance.
nlohmann::json calibration_json(RunFolder& run, const StoredFleet& held, const eval::TruePoses& truth);

}  // namespace fleetmap::run_evaluation
