#include "field_trial.hpp"

#include "fleetmap/core/paths.hpp"
#include "fleetmap/experiment/field_engine.hpp"
#include "grid_run.hpp"

namespace fleetmap::apps {

std::string field_script() {
  return is_there(FLEETMAP_FIELD_SCRIPT) ? FLEETMAP_FIELD_SCRIPT : FLEETMAP_INSTALLED_FIELD_SCRIPT;
}

CommandResult<ExitCode> run_trial(TrialOptions options, std::ostream& out) {
  if (!is_there(options.script)) {
    return exit_with(kUsage, {options.script +
                              ": does not exist; give deploy/netns/field.sh of the source tree as --field"});
  }
  if (!options.traces.empty())
    options.grid.set.push_back("field.trace=" + absolute_path(options.traces).string());
  const MakeEngine engine = [&](const std::atomic<bool>& stop) {
    return experiment::FieldEngine(options.script, options.grid.out, stop);
  };
  return run_grid(options.grid, engine, out);
}

}  // namespace fleetmap::apps
