#include <iostream>
#include <memory>

#include "commands.hpp"
#include "twin_process.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_sim(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TwinOptions>();
  CLI::App* command = app.add_subcommand(
      "sim", "runs the digital twin over DDS, in real time, for agents in other processes");
  command->add_option("-c,--config", options->config, "FLEET.yaml with world: {file: WORLD.yaml}")
      ->required();
  command
      ->add_option("--out", options->out,
                   "writes the ground truth to this folder: NAME/truth.tum and truth.ply")
      ->check(some_path());
  command->add_option("--duration", options->duration, "s, ends after this time")
      ->check(non_negative_number());
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = report(run_twin(*options, std::cout)); });
}

}  // namespace fleetmap::apps
