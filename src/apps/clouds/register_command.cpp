#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "file_registration.hpp"

namespace fleetmap::apps {

void add_register(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RegisterOptions>();
  CLI::App* command =
      app.add_subcommand("register", "registers SOURCE onto TARGET and prints JSON with T_target_source");
  command->add_option("source", options->source, "PLY or PCD")->required();
  command->add_option("target", options->target, "PLY or PCD")->required();
  CLI::Option* prior = command->add_option("--prior", options->prior, "x,y,z,yaw_deg of T_target_source")
                           ->delimiter(',')
                           ->expected(4);
  command->add_option("--sigma", options->sigma, "m,deg: standard deviation of the prior")
      ->delimiter(',')
      ->expected(2)
      ->needs(prior);
  command->add_option("-c,--config", options->config,
                      "AGENT.yaml or FLEET.yaml for the registration settings");
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = report(register_files(*options, std::cout)); });
}

}  // namespace fleetmap::apps
