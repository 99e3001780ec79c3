#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "field_trial.hpp"

namespace fleetmap::apps {

void add_trial(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TrialOptions>();
  options->script = field_script();
  CLI::App* command = app.add_subcommand(
      "trial",
      "runs robots as processes in network namespaces over a grid of QoS profiles, settings "
      "and links, one after another in real time, and reports the results; needs root");
  command->add_option("file", options->grid.config, "TRIAL.yaml: as an experiment, with keys of `field`")
      ->required();
  command
      ->add_option(
          "--traces", options->traces,
          "CSV of links measured in the field: time_s, link, from, to, kbit_s, ms, loss_percent; robots' "
          "own are link_trace.csv")
      ->check(CLI::ExistingFile);
  command->add_option("--field", options->script, "deploy/netns/field.sh");
  options->grid.jobs = 1;  // each needs the machine for itself
  add_grid_options(*command, options->grid);
  command->callback([options, &exit_code] { exit_code = report(run_trial(*options, std::cout)); });
}

}  // namespace fleetmap::apps
