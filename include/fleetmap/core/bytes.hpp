#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fleetmap {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

inline ByteView bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The first 16 bytes of SHA-256: names immutable content, so equal hashes mean equal items.
using ContentHash = std::array<std::uint8_t, 16>;

ContentHash content_hash(ByteView bytes);
std::string to_hex(const ContentHash& hash);

}  // namespace fleetmap
