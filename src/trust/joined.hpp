#pragma once

#include <initializer_list>
#include <string_view>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::trust {

/// One after the other.
Bytes joined(std::initializer_list<ByteView> parts);

inline ByteView bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace fleetmap::trust
