#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/signature.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/trust/signing_key.hpp"

namespace fleetmap::trust {

/// The rights of a member on the radios.
enum class Role : std::uint8_t { kRobot, kObserver };  ///< an observer reads only
const char* to_string(Role role);
Result<Role> parse_role(const std::string& text);

/// First bytes of the SHA-256 of the fleet's authority key.
using FleetId = std::array<std::uint8_t, 8>;
/// First bytes of the SHA-256 of a certificate.
using Fingerprint = std::array<std::uint8_t, 4>;

/// The fleet's authority as members know it: a self-signed X.509 certificate.
struct Authority {
  PublicKey key{};
  FleetId fleet{};
  Stamp not_after;
  Bytes der;
};

/// A member's X.509 certificate whose signature by the authority was verified. The name is the subject's CN,
/// the role its OU (absent: robot).
struct Certificate {
  AgentId name;
  Role role = Role::kRobot;
  std::uint32_t serial = 0;
  Stamp not_before, not_after;
  PublicKey key{};
  Bytes der;
};

/// Serial numbers that the authority withdrew.
struct Revocations {
  std::uint32_t number = 0;  ///< of the list, grows with each revocation
  std::set<std::uint32_t> serials;
};

Authority make_authority(const SigningKey& key, Stamp now);
Certificate issue(const Authority& authority, const SigningKey& authority_key, const AgentId& name, Role role,
                  const PublicKey& key, std::uint32_t serial, Stamp not_before, Stamp not_after);
/// A signed X.509 revocation list.
Bytes sign_revocations(const Authority& authority, const SigningKey& authority_key,
                       const Revocations& revocations, Stamp now);

/// Each fails for what is no such object, and all but the first for what another authority signed.
Result<Authority> parse_authority(ByteView der);
Result<Certificate> parse_certificate(ByteView der, const Authority& authority);
Result<Revocations> parse_revocations(ByteView der, const Authority& authority);

/// Fails if the certificate is revoked or not valid at `now`.
Status check(const Certificate& certificate, const Revocations& revocations, Stamp now);
Fingerprint fingerprint(const Certificate& certificate);
FleetId fleet_of(const PublicKey& authority_key);
/// "2027-03-01".
std::string date(Stamp stamp);

}  // namespace fleetmap::trust
