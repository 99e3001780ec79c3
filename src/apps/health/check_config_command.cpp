#include <iostream>
#include <memory>

#include "commands.hpp"
#include "config_check.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_check_config(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check-config", "checks a YAML file and prints its kind and every error with file and line");
  command->add_option("file", options->file, "FLEET.yaml, AGENT.yaml, WORLD.yaml, an experiment or a sensor")
      ->required();
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->add_option("--agents", options->agents, "only the first N agents of a fleet's file")
      ->check(whole_number(1));
  CLI::Option* network = command->add_flag(
      "--network", options->network,
      "for AGENT.yaml: listens on the radios and prints the robots that are heard, those that are missing "
      "and settings that differ; exit code 1 if there are any");
  command->add_option("--seconds", options->radios.seconds, "s, duration of --network")
      ->needs(network)
      ->check(positive_number());
  command
      ->add_option("--domains", options->radios.domains,
                   "FIRST LAST: DDS domains in which missing robots are searched")
      ->needs(network)
      ->check(CLI::Range(0, 230));
  command->callback([options, &exit_code] { exit_code = report(check_config(*options, std::cout)); });
}

}  // namespace fleetmap::apps
