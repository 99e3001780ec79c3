#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "fleetmap/trust/certificate.hpp"

namespace fleetmap::trust {

using SecretKey = std::array<std::uint8_t, 32>;

/// The symmetric keys that all members share, by epoch. The last one seals; those before only serve to name
/// who still uses them.
using FleetKeys = std::map<std::uint16_t, SecretKey>;
FleetKeys with_new_epoch(FleetKeys keys);
/// A line an epoch: its number and 64 hexadecimal digits. Lines that begin with # are comments.
std::string to_text(const FleetKeys& keys);
Result<FleetKeys> parse_fleet_keys(const std::string& text);

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
  static constexpr std::size_t kMost = 1024;
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

/// Reads a member's folder. Fails with file, what is wrong and what to do: a file that is missing, not what
/// its name says, of another fleet, or secret and readable by others; a key that is not the certificate's; a
/// certificate that is revoked or not valid at `now`.
Result<Credentials> load_credentials(const std::filesystem::path& folder, Stamp now);

}  // namespace fleetmap::trust
