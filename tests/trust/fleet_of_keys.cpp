#include "trust/fleet_of_keys.hpp"

namespace fleetmap::testing {

trust::Credentials FleetOfKeys::member(const std::string& name, trust::Role role, Duration valid) {
  const trust::SigningKey own = trust::SigningKey::generate();
  return {authority,
          trust::issue(authority, key, agent(name), role, own.public_key(), ++last_serial,
                       made - std::chrono::days(1), made + valid),
          own,
          fleet_keys,
          revocations,
          {}};
}

}  // namespace fleetmap::testing
