#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "recording_inspection.hpp"

namespace fleetmap::apps {

void add_inspect(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RecordingOptions>();
  options->scans_needed = false;
  CLI::App* command =
      app.add_subcommand("inspect",
                         "prints the contents of a recording, and errors of its clocks, units, "
                         "rates, mounts and motions; exit code 1 if there are any");
  add_recording_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = report(inspect_recording(*options, std::cout)); });
}

}  // namespace fleetmap::apps
