#include <iostream>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "config_description.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "network_check.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

struct CheckOptions {
  std::string file;
  std::vector<std::string> set;
  std::optional<std::size_t> agents;
  bool network = false;
  NetworkCheckOptions radios;
};

int run_network_check(const CheckOptions& options, const std::vector<config::Override>& overrides) {
  const auto kind = config::check(options.file, overrides);
  if (!kind) return report(kind.error(), kBadConfiguration);
  if (*kind != config::FileKind::kRobot)
    return report({options.file + ": --network needs the file of one robot"}, kUsage);
  const auto robot = config::load_robot(options.file, overrides);
  if (!robot) return report(robot.error(), kBadConfiguration);
  if (options.radios.domains.first > options.radios.domains.second)
    return report({"--domains: the first must not be above the last"}, kUsage);
  const auto fine = check_network(*robot, options.radios);
  if (!fine) return report(fine.error(), kFailed);
  return *fine ? kDone : kFailed;
}

int run(const CheckOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  if (options.network) return run_network_check(options, *overrides);
  const auto checked = describe_config(options.file, *overrides, options.agents);
  if (!checked) return report(checked.error(), kBadConfiguration);
  std::cout << options.file << ": " << *checked << '\n';
  return kDone;
}

}  // namespace

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
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
