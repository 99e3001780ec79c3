#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::ros_codec {

/// First in a header: int32 s, uint32 ns.
inline constexpr std::size_t kStampBytes = 8;

/// The uint32 at byte `at` of a message, in the message's order of bytes.
inline std::uint32_t header_number(ByteView cdr, std::size_t at) {
  const bool little_endian = cdr[1] == 1;
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = (value << 8) | cdr[at + (little_endian ? 3 - k : k)];
  return value;
}

}  // namespace fleetmap::ros_codec
