#include <iostream>
#include <memory>

#include "commands.hpp"
#include "page_service.hpp"
#include "validators.hpp"

namespace fleetmap::apps {

void add_monitor(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<MonitorOptions>();
  options->access.port = 8080;
  CLI::App* command = app.add_subcommand(
      "monitor", "shows a run in a browser, finished or still under way: map, fleet, registrations");
  command->add_option("--store", options->store, "store.db of a robot")->check(some_path());
  command->add_option("--run", options->run, "folder that `run` or the agents write to")->check(some_path());
  command->add_option("--robot", options->robot,
                      "of --run: whose map is shown; else of the one that holds most");
  command
      ->add_option("--without", options->without,
                   "robots, comma-separated, whose nodes and alignments are left out of the map")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--port", options->access.port, "TCP port, 0 for any that is free")
      ->check(whole_number(0, 65535));
  add_access_options(*command, options->access, "");
  command->callback([options, &exit_code] { exit_code = report(serve_page(*options, std::cout)); });
}

}  // namespace fleetmap::apps
