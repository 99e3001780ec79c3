#include "run_measurement.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/run_evaluation/evaluation_summary.hpp"
#include "options.hpp"

namespace fleetmap::apps {

run_evaluation::EvaluationInputs inputs_of(const EvalOptions& options) {
  run_evaluation::EvaluationInputs inputs = options.inputs;
  inputs.pictures = !options.no_pictures;
  inputs.modes = {options.modes.begin(), options.modes.end()};
  if (inputs.modes.contains("all")) inputs.modes = run_evaluation::mode_names();
  inputs.modes.erase("none");
  inputs.overlap = !options.no_overlap;
  return inputs;
}

CommandResult<ExitCode> measure_run(const EvalOptions& options, std::ostream& out) {
  if (is_folder(options.directory)) {
    if (const Status writable = check_writable(options.directory); !writable)
      return exit_with(kFailed, writable.error());
  }
  const auto evaluation = run_evaluation::evaluate_run(options.directory, inputs_of(options));
  if (!evaluation) return exit_with(kFailed, evaluation.error());
  run_evaluation::print_summary(out, options.directory, *evaluation);
  if (!run_evaluation::measured_anything(*evaluation))
    return exit_with(kFailed, {options.directory + ": nothing could be measured, see the notes"});
  return kDone;
}

}  // namespace fleetmap::apps
