#pragma once

#include <cstdint>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::store {

/// The number in `bytes`, at most 8, the first one the highest: as SQLite's files hold numbers.
inline std::uint64_t big_endian(ByteView bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

}  // namespace fleetmap::store
