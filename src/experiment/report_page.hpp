#pragma once

#include "fleetmap/experiment/runner.hpp"
#include "fleetmap/experiment/shape_check.hpp"

namespace fleetmap::experiment {

/// report.html: one file that shows every study (min-mean-max over the seeds, histograms, maps of the first
/// seed), the verdicts on the shapes, and what failed. Pictures are read from `directory`/cases and embedded;
/// one that cannot be read is left out.
std::string report_page(const config::ExperimentConfig& config, const Outcome& outcome,
                        const std::vector<ShapeCheck>& checks, const std::filesystem::path& directory);

}  // namespace fleetmap::experiment
