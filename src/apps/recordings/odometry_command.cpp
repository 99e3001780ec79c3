#include <iostream>
#include <memory>

#include "commands.hpp"
#include "recording_odometry.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_odometry(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<OdometryOptions>();
  CLI::App* command = app.add_subcommand(
      "odometry", "runs the odometry alone on a recording and writes a TUM trajectory of base_link");
  add_recording_options(*command, options->input);
  command->add_option("--out", options->out, "TUM file")->required()->check(some_path());
  command->callback([options, &exit_code] { exit_code = report(trace_recording(*options, std::cout)); });
}

}  // namespace fleetmap::apps
