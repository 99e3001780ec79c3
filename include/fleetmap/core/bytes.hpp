#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fleetmap {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// The first 16 bytes of SHA-256: names immutable content, so equal hashes mean equal items.
using ContentHash = std::array<std::uint8_t, 16>;

ContentHash content_hash(ByteView bytes);
std::string to_hex(const ContentHash& hash);

}  // namespace fleetmap
