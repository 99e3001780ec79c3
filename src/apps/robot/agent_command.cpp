#include <iostream>
#include <memory>

#include "agent_run.hpp"
#include "commands.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_agent(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<AgentOptions>();
  CLI::App* command =
      app.add_subcommand("agent", "runs one robot over DDS until SIGINT or SIGTERM, then writes its map");
  command->add_option("-c,--config", options->config, "AGENT.yaml, or FLEET.yaml with --as")->required();
  CLI::Option* as = command->add_option(
      "--as", options->as, "name of the agent in FLEET.yaml, whose agents all run on this machine");
  command
      ->add_option(
          "--out", options->out,
          "with --as: writes the agent's files to OUT/NAME; else they go to `directory` of the configuration")
      ->needs(as)
      ->check(some_path());
  add_record_options(*command, options->record,
                     "write the sensor topics and the robot's own output as a rosbag2 bag into this folder");
  command
      ->add_option("--exit-after-idle", options->exit_after_idle,
                   "s; exits when sensors and exchange were silent for so long; a minute later if no scan "
                   "was received yet, and another minute later if a robot lacks a part of the map")
      ->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  add_page_options(*command, options->monitor, "with what this robot holds");
  command->callback([options, &exit_code] { exit_code = report(run_agent(*options, std::cout)); });
}

}  // namespace fleetmap::apps
