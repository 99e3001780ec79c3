#pragma once

#include <array>
#include <cstdint>

namespace fleetmap::trust {

/// Accepts each counter of a sender once, in any order within the last 1024 (RFC 6479).
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;
  ReplayWindow() = default;
  /// Accepts none up to `last`.
  explicit ReplayWindow(std::uint64_t last) : newest_(last) {
    received_.fill(~std::uint64_t{0});
    clear_above(last);
  }
  /// False for a counter that was accepted before or is older than the window.
  bool accept(std::uint64_t counter);

 private:
  static constexpr std::uint64_t kBits = 64, kWords = kSize / kBits + 1;  ///< a word is cleared ahead
  void clear_above(std::uint64_t counter);

  std::array<std::uint64_t, kWords> received_{};
  std::uint64_t newest_ = 0;  ///< 0: none yet
};

}  // namespace fleetmap::trust
