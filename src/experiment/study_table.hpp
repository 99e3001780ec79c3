#pragma once

#include <string>
#include <vector>

#include "study_values.hpp"

namespace fleetmap::experiment {

/// "title [unit]" of a metric, its name where the file gives it no title.
std::string metric_title(const config::ExperimentConfig& config, const std::string& name);

/// "rate=10 Hz, team=plain"; "all" of a study without axes.
std::string point_name(const Slice& point);

/// A row a metric, a column a point: "mean [min, max]" over the seeds, and of how many runs where some did
/// not give it. The first row holds the points' names, the second how many runs came to their end.
std::vector<std::vector<std::string>> study_table(const config::ExperimentConfig& config,
                                                  const config::Study& study,
                                                  const std::vector<CaseRecord>& records);

/// tables.md: every study's table in Markdown, to be put into a document.
std::string markdown_tables(const config::ExperimentConfig& config, const std::vector<CaseRecord>& records);

}  // namespace fleetmap::experiment
