#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>

namespace fleetmap::run_evaluation {

/// A few lines on what evaluate_run() measured in `directory`.
void print_summary(std::ostream& out, const std::string& directory, const nlohmann::json& evaluation);

/// The evaluation holds numbers of the map or of a trajectory.
bool measured_anything(const nlohmann::json& evaluation);

}  // namespace fleetmap::run_evaluation
