#include "trust/fleet_of_keys.hpp"

namespace fleetmap::testing {

trust::Credentials FleetOfKeys::member(const std::string& name, trust::Role role, Stamp not_after) {
  const trust::SigningKey own = trust::SigningKey::generate();
  return {authority,
          trust::issue(authority, key, agent(name), role, own.public_key(), ++last_serial,
                       kNow - std::chrono::days(1), not_after),
          own,
          fleet_keys,
          revocations,
          {}};
}

}  // namespace fleetmap::testing
