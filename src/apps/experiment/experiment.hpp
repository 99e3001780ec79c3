#pragma once

#include <atomic>
#include <ostream>

#include "experiment/runner.hpp"
#include "experiment/shape_check.hpp"

namespace fleetmap::apps::experiment {

struct ExperimentResult {
  Outcome outcome;
  std::vector<ShapeCheck> checks;

  /// Every case was run and none failed, and every expected shape is there.
  bool good() const;
};

/// Runs what is still to be run and writes results.json, results.csv, tables.md and report.html into
/// `runner.directory`, after an interrupt too (of what there is). Tells `out` how it goes and what came of
/// it.
Result<ExperimentResult> run_experiment(const config::ExperimentConfig& config, const Engine& engine,
                                        const RunnerConfig& runner, const std::atomic<bool>& stop,
                                        std::ostream& out, bool terminal);

}  // namespace fleetmap::apps::experiment
