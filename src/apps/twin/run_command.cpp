#include <iostream>
#include <memory>

#include "commands.hpp"
#include "fleet_run.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run", "runs a whole fleet in one process, in virtual time, from the twin or from recordings");
  command->add_option("-c,--config", options->config, "FLEET.yaml");
  command
      ->add_option("--recording", options->recordings,
                   "NAME=PATH of one robot's recording, instead of a file")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "folder for maps, trajectories and the report")
      ->required()
      ->check(some_path());
  add_record_options(
      *command, options->record,
      "also write each robot's sensor samples, and what it publishes for ROS 2, as a bag into DIR/NAME");
  command->add_option("--agents", options->agents, "only the first N agents of the file")
      ->check(whole_number(1));
  command
      ->add_option("--threads", options->threads,
                   "maximum number of threads; the result does not depend on it")
      ->check(whole_number(1, 256))
      ->default_str("one for each core");
  command
      ->add_option(
          "--first-session", options->first_session,
          "number of the robots' first session, and hours by which the twin begins later; runs that are "
          "merged need different numbers")
      ->check(whole_number(0, 60'000));
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  add_page_options(*command, options->monitor, "while the run goes on");
  command->callback([options, &exit_code] { exit_code = report(run_fleet(*options, std::cout)); });
}

}  // namespace fleetmap::apps
