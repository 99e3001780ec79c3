#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "fleetmap/eval/html_page.hpp"
#include "fleetmap/run_evaluation/map_pictures.hpp"
#include "run_folder.hpp"

namespace fleetmap::run_evaluation {

/// evaluation.html: pictures, tables and plots of what evaluate_run() measured.
eval::HtmlPage evaluation_page(const RunFolder& run, const nlohmann::json& evaluation,
                               const std::vector<MapPicture>& pictures);

}  // namespace fleetmap::run_evaluation
