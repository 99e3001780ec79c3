#pragma once

#include <atomic>
#include <ostream>

#include "fleetmap/experiment/runner.hpp"
#include "fleetmap/experiment/shape_check.hpp"

namespace fleetmap::experiment {

/// Records of all cases, and the checks of the expected shapes.
struct ExperimentResult {
  Outcome outcome;
  std::vector<ShapeCheck> checks;

  /// Every case was run and none failed, and every required shape is there.
  bool good() const;
};

/// Runs what is still to be run and writes results.json, results.csv, tables.md, plots/ and report.html into
/// `runner.directory`, after an interrupt too (of what there is). Prints to `out` how it goes and what came
/// of it.
Result<ExperimentResult> run_experiment(const config::ExperimentConfig& config, const Engine& engine,
                                        const RunnerConfig& runner, const std::atomic<bool>& stop,
                                        std::ostream& out, bool terminal);

/// Writes the same of what there is, without running anything.
Result<ExperimentResult> report_experiment(const config::ExperimentConfig& config, const RunnerConfig& runner,
                                           std::ostream& out);

}  // namespace fleetmap::experiment
