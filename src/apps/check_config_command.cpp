#include <iostream>
#include <memory>

#include "commands.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "options.hpp"

namespace fleetmap::apps {

void add_check_config(CLI::App& app, int& exit_code) {
  struct Options {
    std::string file;
    std::vector<std::string> set;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check-config", "says what is wrong with a configuration, file:line by line");
  command->add_option("file", options->file, "AGENT.yaml or FLEET.yaml")->required();
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] {
    const auto overrides = parse_overrides(options->set);
    if (!overrides) {
      exit_code = report(overrides.error(), kUsage);
      return;
    }
    const auto kind = config::check(options->file, *overrides);
    if (!kind) {
      exit_code = report(kind.error(), kBadConfiguration);
      return;
    }
    std::cout << options->file << ": a valid " << (*kind == config::FileKind::kFleet ? "fleet" : "agent")
              << " configuration\n";
  });
}

}  // namespace fleetmap::apps
