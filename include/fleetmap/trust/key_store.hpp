#pragma once

#include <filesystem>
#include <vector>

#include "fleetmap/trust/credentials.hpp"

namespace fleetmap::trust {

/// The operator's folder: the authority's key, all certificates that it issued, and for each member a folder
/// to be copied to it.
///
///   ca.key, fleet.keys        secret
///   ca.pem, revoked.pem
///   issued/NAME-SERIAL.pem    every certificate, also of members that were revoked
///   NAME/                     a member's folder (file::k...)
class KeyStore {
 public:
  struct Member {
    Certificate certificate;
    bool revoked = false;
  };

  /// Makes a fleet in a folder that has none.
  static Result<KeyStore> init(const std::filesystem::path& folder, Stamp now);
  static Result<KeyStore> open(const std::filesystem::path& folder);

  /// Makes keys and folder of a member, and brings the other members' folders up to date. Fails if it has a
  /// certificate already that is valid for another 30 days.
  Result<Certificate> add(const AgentId& name, Role role, std::chrono::days valid, Stamp now);
  /// Withdraws all certificates of a member, removes its folder, and begins a new epoch of the fleet's key:
  /// the folders of all others must be copied anew.
  Status revoke(const AgentId& name, Stamp now);

  const std::vector<Member>& members() const { return members_; }
  const Authority& authority() const { return authority_; }
  std::uint16_t epoch() const { return keys_.rbegin()->first; }

 private:
  KeyStore(std::filesystem::path folder, SigningKey key, Authority authority)
      : folder_(std::move(folder)), key_(std::move(key)), authority_(std::move(authority)) {}
  Status save(Stamp now) const;
  /// Writes the files that all members share.
  Status refresh(const std::filesystem::path& member_folder) const;
  Status read_issued();

  std::filesystem::path folder_;
  SigningKey key_;
  Authority authority_;
  FleetKeys keys_;
  Revocations revocations_;
  std::vector<Member> members_;  ///< in the order of names and serial numbers
};

}  // namespace fleetmap::trust
