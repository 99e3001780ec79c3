#pragma once

#include <string>
#include <vector>

#include "fleetmap/run_evaluation/evaluation.hpp"

namespace fleetmap::apps {

/// Measurements of a run, as the command line has them.
struct EvalOptions {
  std::string directory;  ///< the run's --out
  run_evaluation::EvaluationInputs inputs;
  bool no_pictures = false;
  std::vector<std::string> modes{"all"};  ///< run_evaluation::mode_names(), "all" or "none"
  bool no_overlap = false;
};

}  // namespace fleetmap::apps
