// `fleetmap keys`: who belongs to the fleet.
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/trust/key_store.hpp"
#include "options.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::uint64_t kMaxDays = 7300;

struct KeysOptions {
  std::string folder;
  std::string name;
  std::string role = "robot";
  std::uint32_t days = 365;
};

int init(const KeysOptions& options) {
  const auto keys = trust::KeyStore::init(options.folder, system_now());
  if (!keys) return report(keys.error(), kFailed);
  std::cout << options.folder
            << ": keys of a new fleet; keep the folder where no robot goes, and a copy of it\n";
  return kDone;
}

int add(const KeysOptions& options) {
  const auto name = AgentId::parse(options.name);
  if (!name) return report(name.error(), kUsage);
  auto keys = trust::KeyStore::open(options.folder);
  if (!keys) return report(keys.error(), kFailed);
  const auto role = trust::parse_role(options.role);
  if (!role) return report(role.error(), kUsage);
  const auto added = keys->add(*name, *role, std::chrono::days(options.days), system_now());
  if (!added) return report(added.error(), kFailed);
  std::cout << options.folder << '/' << options.name << ": keys of " << options.name << ", "
            << trust::to_string(added->role) << ", valid until " << trust::date(added->not_after)
            << "; copy the folder to it (cp -p, scp -p), and give its file: keys: FOLDER\n";
  return kDone;
}

int revoke(const KeysOptions& options) {
  const auto name = AgentId::parse(options.name);
  if (!name) return report(name.error(), kUsage);
  auto keys = trust::KeyStore::open(options.folder);
  if (!keys) return report(keys.error(), kFailed);
  if (const Status revoked = keys->revoke(*name, system_now()); !revoked)
    return report(revoked.error(), kFailed);
  std::cout
      << options.name << " is revoked, and the fleet has a new key (" << keys->epoch()
      << "): copy the folders of all others to them and start them anew; who has the old one is not heard\n";
  return kDone;
}

int show(const KeysOptions& options) {
  const auto keys = trust::KeyStore::open(options.folder);
  if (!keys) return report(keys.error(), kFailed);
  std::cout << "fleet key " << keys->epoch() << ", authority valid until "
            << trust::date(keys->authority().not_after) << '\n';
  for (const auto& member : keys->members()) {
    const trust::Certificate& certificate = member.certificate;
    const char* state = member.revoked                         ? "revoked"
                        : certificate.not_after < system_now() ? "expired"
                                                               : "valid";
    std::cout << certificate.name.str() << ' ' << trust::to_string(certificate.role) << ' ' << state
              << " until " << trust::date(certificate.not_after) << ", serial " << certificate.serial << '\n';
  }
  return kDone;
}

CLI::App* add_action(CLI::App& keys, const std::shared_ptr<KeysOptions>& options, const char* name,
                     const char* help, int (*run)(const KeysOptions&), int& exit_code) {
  CLI::App* action = keys.add_subcommand(name, help);
  action->add_option("--dir", options->folder, "folder of the fleet's keys")->required()->check(some_path());
  action->callback([options, run, &exit_code] { exit_code = run(*options); });
  return action;
}

}  // namespace

void add_keys(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<KeysOptions>();
  CLI::App* keys =
      app.add_subcommand("keys", "who belongs to the fleet; without keys anyone on the radio does");
  keys->require_subcommand(1);
  add_action(*keys, options, "init", "makes the keys of a fleet", init, exit_code);
  CLI::App* adds = add_action(*keys, options, "add", "makes the folder of keys of a robot", add, exit_code);
  adds->add_option("name", options->name, "the robot, as its file's id")->required();
  adds->add_option("--role", options->role, "robot, or observer: reads only")
      ->check(CLI::IsMember({"robot", "observer"}));
  adds->add_option("--days", options->days, "that they are valid")->check(whole_number(1, kMaxDays));
  CLI::App* revokes = add_action(*keys, options, "revoke",
                                 "withdraws the keys of a robot that was lost or stolen", revoke, exit_code);
  revokes->add_option("name", options->name, "the robot")->required();
  add_action(*keys, options, "show", "lists who has keys", show, exit_code);
}

}  // namespace fleetmap::apps
