#pragma once

#include <iosfwd>

#include "command_result.hpp"
#include "eval_options.hpp"

namespace fleetmap::apps {

/// The inputs, with the choices that the command line has in words of its own.
run_evaluation::EvaluationInputs inputs_of(const EvalOptions& options);

/// Measures a run, writes its evaluation beside it and prints a summary to `out`. Fails if nothing could be
/// measured.
CommandResult<ExitCode> measure_run(const EvalOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
