#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "fleetmap/trust/certificate.hpp"
#include "fleetmap/trust/fleet_keys.hpp"

namespace fleetmap::trust {

/// Files of a member's folder.
namespace file {
inline constexpr const char* kAuthority = "ca.pem";
inline constexpr const char* kCertificate = "robot.pem";
inline constexpr const char* kKey = "robot.key";         ///< mode 0600
inline constexpr const char* kFleetKeys = "fleet.keys";  ///< mode 0600
inline constexpr const char* kRevocations = "revoked.pem";
inline constexpr const char* kMembers =
    "members.pem";  ///< certificates of all members, which the radio then spares
}  // namespace file

/// Certificates that came in greetings and were not in the folder. From any thread.
class LearnedCertificates {
 public:
  void add(const Certificate& certificate);
  std::vector<Certificate> all() const;

 private:
  static constexpr std::size_t kMax = 1024;
  mutable std::mutex mutex_;  ///< guards all below
  std::vector<Certificate> certificates_;
};

/// All that one member has.
struct Credentials {
  Authority authority;
  Certificate certificate;
  SigningKey key;
  FleetKeys fleet_keys;
  Revocations revocations;
  std::vector<Certificate> members;
  /// Grows while the robot runs.
  std::shared_ptr<LearnedCertificates> learned = std::make_shared<LearnedCertificates>();

  std::uint16_t epoch() const { return fleet_keys.rbegin()->first; }
};

/// Reads a member's folder. Fails with file, problem and remedy: a file that is missing, of another type, of
/// another fleet, or secret and readable by others; a key that is not the certificate's; a certificate that
/// is revoked or not valid at `now`.
Result<Credentials> load_credentials(const std::filesystem::path& folder, Stamp now);

}  // namespace fleetmap::trust
