// `fleetmap keys`: who belongs to the fleet.
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "key_administration.hpp"
#include "validators.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::uint64_t kMaxDays = 7300;

using Action = CommandResult<ExitCode> (*)(const KeysOptions& options, std::ostream& out);

CLI::App* add_action(CLI::App& keys, const std::shared_ptr<KeysOptions>& options, const char* name,
                     const char* help, Action run, int& exit_code) {
  CLI::App* action = keys.add_subcommand(name, help);
  action->add_option("--dir", options->folder, "folder of the fleet's keys")->required()->check(some_path());
  action->callback([options, run, &exit_code] { exit_code = report(run(*options, std::cout)); });
  return action;
}

}  // namespace

void add_keys(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<KeysOptions>();
  CLI::App* keys =
      app.add_subcommand("keys", "manages the keys of a fleet; without keys its radios accept every robot");
  keys->require_subcommand(1);
  add_action(*keys, options, "init", "makes the keys of a fleet", make_fleet_keys, exit_code);
  CLI::App* adds =
      add_action(*keys, options, "add", "makes the folder of keys of a robot", add_member, exit_code);
  adds->add_option("name", options->name, "the robot, as its file's id")->required();
  adds->add_option("--role", options->role, "robot, or observer, which only reads")
      ->check(CLI::IsMember({"robot", "observer"}));
  adds->add_option("--days", options->days, "days for which the keys are valid")
      ->check(whole_number(1, kMaxDays));
  CLI::App* revokes =
      add_action(*keys, options, "revoke", "withdraws the keys of a robot that was lost or stolen",
                 revoke_member, exit_code);
  revokes->add_option("name", options->name, "the robot")->required();
  add_action(*keys, options, "show", "lists the members that have keys", list_members, exit_code);
}

}  // namespace fleetmap::apps
