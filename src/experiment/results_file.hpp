#pragma once

#include <nlohmann/json_fwd.hpp>

#include "fleetmap/experiment/runner.hpp"
#include "fleetmap/experiment/shape_check.hpp"

namespace fleetmap::experiment {

/// results.json: every case, min-mean-max of every study's metrics, and the verdicts on the shapes.
nlohmann::json results_json(const config::ExperimentConfig& config, const Outcome& outcome,
                            const std::vector<ShapeCheck>& checks);

/// results.csv: one row a case, a column for each axis and each metric that any case gave; empty where a case
/// has none.
std::string results_csv(const config::ExperimentConfig& config, const Outcome& outcome);

}  // namespace fleetmap::experiment
