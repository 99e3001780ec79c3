#include <iostream>
#include <memory>

#include "commands.hpp"
#include "config_check.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_check_config(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check-config", "says what a YAML file is and what is wrong with it, file:line by line");
  command->add_option("file", options->file, "FLEET.yaml, AGENT.yaml, WORLD.yaml, an experiment or a sensor")
      ->required();
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->add_option("--agents", options->agents, "only the first N agents of a fleet's file")
      ->check(whole_number(1));
  CLI::Option* network = command->add_flag(
      "--network", options->network,
      "a robot's file: listens on its radios and says who is heard, who is not and what differs; 1 if so");
  command->add_option("--seconds", options->radios.seconds, "s, to listen")
      ->needs(network)
      ->check(positive_number());
  command
      ->add_option("--domains", options->radios.domains,
                   "FIRST LAST: DDS domains in which robots that are not heard are looked for")
      ->needs(network)
      ->check(CLI::Range(0, 230));
  command->callback([options, &exit_code] { exit_code = report(check_config(*options, std::cout)); });
}

}  // namespace fleetmap::apps
