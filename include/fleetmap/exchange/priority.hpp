#pragma once

#include <cstddef>
#include <cstdint>

namespace fleetmap::exchange {

/// Priority of messages on the radio. Safety and control go first. News and state, in this order, go before
/// backfill, and all three before clouds. While clouds wait, they get more than half of the remaining
/// budget, and backfill gets half of the rest.
enum class Priority : std::uint8_t {
  kSafety,    ///< orders to stop
  kControl,   ///< matches and requests: a few bytes that set others to work
  kNews,      ///< own new nodes and alignments
  kState,     ///< digests and status
  kBackfill,  ///< requested items
  kCloud      ///< fragments of spherized clouds
};
inline constexpr std::size_t kPriorities = 6;

}  // namespace fleetmap::exchange
