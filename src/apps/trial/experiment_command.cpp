#include <iostream>
#include <memory>

#include "commands.hpp"
#include "twin_grid.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_experiment(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<GridOptions>();
  CLI::App* command = app.add_subcommand(
      "experiment", "runs fleets in the twin over a grid of settings and seeds, and reports the results");
  command->add_option("-c,--config", options->config, "EXPERIMENT.yaml")->required();
  command->add_option("--jobs", options->jobs, "cases that run at a time, each in its own process")
      ->check(whole_number(1, 1024))
      ->default_str("one for each core");
  add_grid_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = report(run_grid_in_twin(*options, std::cout)); });
}

}  // namespace fleetmap::apps
