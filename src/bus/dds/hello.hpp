#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"

namespace fleetmap::bus {

/// fleetmap::msg::Hello, by which robots find each other on a radio.
struct Hello {
  std::array<std::uint8_t, 12> knows{};  ///< RTPS prefix of whom the sender knows at this place; zero: nobody
  bool leaves = false;                   ///< the sender's last message
  AgentId sender;
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
  std::vector<std::uint32_t> reads;  ///< entity ids of topics, at most kMostReads
};
inline constexpr std::size_t kMostReads = 64;

Bytes encode(const Hello& hello);
/// Empty for what is no Hello of this version.
std::optional<Hello> decode_hello(const Bytes& cdr);

}  // namespace fleetmap::bus
