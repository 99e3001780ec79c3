#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/experiment/field_engine.hpp"
#include "grid_command.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;

/// The script of the source tree that the program was built in, else that of the package.
std::string field_script() {
  return is_there(FLEETMAP_FIELD_SCRIPT) ? FLEETMAP_FIELD_SCRIPT : FLEETMAP_INSTALLED_FIELD_SCRIPT;
}

struct TrialOptions {
  GridOptions grid;
  std::string traces;
  std::string script = field_script();
};

int run(TrialOptions options) {
  if (!is_there(options.script)) {
    return report(
        {options.script + ": does not exist; give deploy/netns/field.sh of the source tree as --field"},
        kUsage);
  }
  if (!options.traces.empty())
    options.grid.set.push_back("field.trace=" + absolute_path(options.traces).string());
  return run_grid(options.grid, [&](const std::atomic<bool>& stop) {
    return experiment::FieldEngine(options.script, options.grid.out, stop);
  });
}

}  // namespace

void add_trial(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TrialOptions>();
  CLI::App* command = app.add_subcommand(
      "trial",
      "runs robots as processes in network namespaces over a grid of QoS profiles, settings "
      "and links, one after another in real time, and reports what came of it; root");
  command->add_option("file", options->grid.config, "TRIAL.yaml: as an experiment, with keys of `field`")
      ->required();
  command
      ->add_option(
          "--traces", options->traces,
          "CSV of what links had in the field: time_s, link, from, to, kbit_s, ms, loss_percent; robots' "
          "own are link_trace.csv")
      ->check(CLI::ExistingFile);
  command->add_option("--field", options->script, "deploy/netns/field.sh");
  options->grid.jobs = 1;  // each needs the machine for itself
  add_grid_options(*command, options->grid);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
