#include "key_administration.hpp"

#include <chrono>
#include <ostream>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/trust/key_store.hpp"

namespace fleetmap::apps {

CommandResult<ExitCode> make_fleet_keys(const KeysOptions& options, std::ostream& out) {
  const auto keys = trust::KeyStore::init(options.folder, system_now());
  if (!keys) return exit_with(kFailed, keys.error());
  out << options.folder << ": keys of a new fleet; keep the folder where no robot goes, and a copy of it\n";
  return kDone;
}

CommandResult<ExitCode> add_member(const KeysOptions& options, std::ostream& out) {
  const auto name = AgentId::parse(options.name);
  if (!name) return exit_with(kUsage, name.error());
  auto keys = trust::KeyStore::open(options.folder);
  if (!keys) return exit_with(kFailed, keys.error());
  const auto role = trust::parse_role(options.role);
  if (!role) return exit_with(kUsage, role.error());
  const auto added = keys->add(*name, *role, std::chrono::days(options.days), system_now());
  if (!added) return exit_with(kFailed, added.error());
  out << options.folder << '/' << options.name << ": keys of " << options.name << ", "
      << trust::to_string(added->role) << ", valid until " << trust::date(added->not_after)
      << "; copy the folder to it (cp -p, scp -p), and give its file: keys: FOLDER\n";
  return kDone;
}

CommandResult<ExitCode> revoke_member(const KeysOptions& options, std::ostream& out) {
  const auto name = AgentId::parse(options.name);
  if (!name) return exit_with(kUsage, name.error());
  auto keys = trust::KeyStore::open(options.folder);
  if (!keys) return exit_with(kFailed, keys.error());
  if (const Status revoked = keys->revoke(*name, system_now()); !revoked)
    return exit_with(kFailed, revoked.error());
  out << options.name << " is revoked, and the fleet has a new key (" << keys->epoch()
      << "): copy the folders of all others to them and start them anew; who has the old one is not heard\n";
  return kDone;
}

CommandResult<ExitCode> list_members(const KeysOptions& options, std::ostream& out) {
  const auto keys = trust::KeyStore::open(options.folder);
  if (!keys) return exit_with(kFailed, keys.error());
  out << "fleet key " << keys->epoch() << ", authority valid until "
      << trust::date(keys->authority().not_after) << '\n';
  for (const auto& member : keys->members()) {
    const trust::Certificate& certificate = member.certificate;
    const char* state = member.revoked                         ? "revoked"
                        : certificate.not_after < system_now() ? "expired"
                                                               : "valid";
    out << certificate.name.str() << ' ' << trust::to_string(certificate.role) << ' ' << state << " until "
        << trust::date(certificate.not_after) << ", serial " << certificate.serial << '\n';
  }
  return kDone;
}

}  // namespace fleetmap::apps
