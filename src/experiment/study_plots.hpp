#pragma once

#include <string>
#include <vector>

#include "fleetmap/experiment/case_record.hpp"

namespace fleetmap::experiment {

/// A plot of a study, alone in a file or in a page.
struct StudyPlot {
  std::string name;  ///< of its file without the suffix: "fleet_size_map.rmse"
  std::string svg;
};

/// A plot a metric: min-mean-max over the seeds along the study's first axis, a line for each combination of
/// the other axes; bars of the means where the first axis has names instead of numbers. Metrics that belong
/// to another one of the study (MetricSpec::with) are lines of its plot. Then a plot a histogram, of the
/// first seed.
std::vector<StudyPlot> study_plots(const config::ExperimentConfig& config, const config::Study& study,
                                   const std::vector<CaseRecord>& records);

}  // namespace fleetmap::experiment
