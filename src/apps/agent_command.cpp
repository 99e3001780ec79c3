#include <iostream>
#include <memory>

#include "agent_run.hpp"
#include "commands.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_agent(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<AgentOptions>();
  CLI::App* command =
      app.add_subcommand("agent", "one robot over DDS; ends with SIGINT or SIGTERM and writes its map");
  command->add_option("-c,--config", options->config, "AGENT.yaml, or FLEET.yaml with --as")->required();
  CLI::Option* as = command->add_option("--as", options->as, "this agent of FLEET.yaml, all on this machine");
  command
      ->add_option(
          "--out", options->out,
          "with --as: the agent keeps its files in OUT/NAME; without, the file's directory says where")
      ->needs(as)
      ->check(some_path());
  add_record_options(*command, options->record,
                     "write the sensor topics and the robot's own output as a rosbag2 bag into this folder");
  command
      ->add_option("--exit-after-idle", options->exit_after_idle,
                   "s; end by itself when sensors and exchange have been silent for so long; a minute later "
                   "while no scan was heard yet, and another while somebody lacks a part of the map")
      ->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  add_page_options(*command, options->monitor, "with what this robot holds");
  command->callback([options, &exit_code] { exit_code = report(run_agent(*options, std::cout)); });
}

}  // namespace fleetmap::apps
