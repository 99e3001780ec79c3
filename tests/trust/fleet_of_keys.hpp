#pragma once

#include <string>

#include "fleetmap/trust/credentials.hpp"

namespace fleetmap::testing {

/// When the tests play.
inline const Stamp kNow = stamp_from_ns(1'800'000'000'000'000'000);

inline AgentId agent(const std::string& name) { return AgentId::parse(name).value(); }

/// A fleet's authority and its members, without files.
struct FleetOfKeys {
  Stamp made = kNow;
  trust::SigningKey key = trust::SigningKey::generate();
  trust::Authority authority = trust::make_authority(key, made);
  trust::FleetKeys fleet_keys = trust::with_new_epoch({});
  trust::Revocations revocations{};
  std::uint32_t last_serial = 0;

  trust::Credentials member(const std::string& name, trust::Role role = trust::Role::kRobot,
                            Duration valid = std::chrono::days(365));
};

}  // namespace fleetmap::testing
