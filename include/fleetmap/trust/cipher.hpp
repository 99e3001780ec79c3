#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/trust/certificate.hpp"
#include "fleetmap/trust/fleet_keys.hpp"

namespace fleetmap::trust {

/// Names one start of one robot on one radio: drawn at random for each, so that it is salt of the sender's
/// key and challenge to others at once.
using Session = std::array<std::uint8_t, 12>;

/// `first` and 80 random bits: RTPS prefixes begin with their vendor.
Session draw_session(const std::array<std::uint8_t, 2>& first);

inline constexpr std::size_t kTagBytes = 16;

/// Authenticated encryption under one key.
class Cipher {
 public:
  explicit Cipher(const SecretKey& key);
  ~Cipher();
  Cipher(Cipher&&) noexcept;
  Cipher& operator=(Cipher&&) noexcept;
  /// Appends the sealed message to `header`, which it authenticates. The counter is used once.
  void seal(std::uint64_t counter, Bytes& header, ByteView message);
  /// Empty if any bit is not as it was sealed.
  std::optional<Bytes> open(std::uint64_t counter, ByteView header, ByteView sealed);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

SecretKey session_key(const SecretKey& fleet_key, const FleetId& fleet, std::uint16_t epoch,
                      std::uint8_t radio, const Session& session);

}  // namespace fleetmap::trust
