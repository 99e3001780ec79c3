#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// The bytes that published test vectors give as hexadecimal digits.
inline Bytes from_hex(std::string_view digits) {
  Bytes bytes(digits.size() / 2);
  for (std::size_t k = 0; k < bytes.size(); ++k)
    std::from_chars(digits.data() + 2 * k, digits.data() + 2 * k + 2, bytes[k], 16);
  return bytes;
}

template <std::size_t kSize>
std::array<std::uint8_t, kSize> array_from_hex(std::string_view digits) {
  std::array<std::uint8_t, kSize> bytes{};
  std::ranges::copy(from_hex(digits.substr(0, 2 * kSize)), bytes.begin());
  return bytes;
}

}  // namespace fleetmap::testing
