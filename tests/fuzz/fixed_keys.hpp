#pragma once

#include <string>

#include "fleetmap/trust/credentials.hpp"

/// A fleet whose keys are no secret and the same in each run, so that inputs of the corpus stay valid.
namespace fleetmap::fuzz {

inline const Stamp kNow = stamp_from_ns(1'800'000'000'000'000'000);

inline trust::SigningKey fixed_key(const std::string& last_half) {
  return trust::SigningKey::from_pem("-----BEGIN PRIVATE KEY-----\nMC4CAQAwBQYDK2VwBCIEI" + last_half +
                                     "\n-----END PRIVATE KEY-----\n")
      .value();
}
inline trust::SigningKey authority_key() { return fixed_key("AABAgMEBQYHCAkKCwwNDg8QERITFBUWFxgZGhscHR4f"); }
inline trust::SigningKey key_of_r1() { return fixed_key("CAhIiMkJSYnKCkqKywtLi8wMTIzNDU2Nzg5Ojs8PT4/"); }
inline trust::SigningKey key_of_r2() { return fixed_key("EBBQkNERUZHSElKS0xNTk9QUVJTVFVWV1hZWltcXV5f"); }

inline trust::Credentials credentials_of(const std::string& name, const trust::SigningKey& key,
                                         std::uint32_t serial) {
  const trust::Authority authority = trust::make_authority(authority_key(), kNow);
  return {authority,
          trust::issue(authority, authority_key(), AgentId::parse(name).value(), trust::Role::kRobot,
                       key.public_key(), serial, kNow - std::chrono::days(1), kNow + std::chrono::days(365)),
          key,
          {{1, trust::SecretKey{1, 2, 3}}, {2, trust::SecretKey{4, 5, 6}}},
          {},
          {}};
}

}  // namespace fleetmap::fuzz
