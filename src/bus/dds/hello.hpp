#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/bus/fleet_settings.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"

namespace fleetmap::bus {

/// fleetmap::msg::Hello, by which robots find each other on a radio.
struct Hello {
  std::array<std::uint8_t, 12>
      knows{};          ///< RTPS prefix of the peer that the sender has at this address; zero: none
  bool leaves = false;  ///< the sender's last message
  AgentId sender;
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
  std::optional<FleetSettings> settings;  ///< empty: an operator's program
  Link link = Link::kLongRange;           ///< that the sender uses here
  bool multicast = false;                 ///< the sender listens at the group
  std::vector<std::uint32_t> reads;       ///< entity ids of topics, at most kMaxReads
};
inline constexpr std::size_t kMaxReads = 64;

/// A Hello that another version of fleetmap sent: what it has in common with this one's.
struct OtherHello {
  std::uint8_t version = 0;
  AgentId sender;
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
};

Bytes encode(const Hello& hello);
/// Empty for what is no Hello of this version.
std::optional<Hello> decode_hello(const Bytes& cdr);
/// Empty for a Hello of this version, and for what is none.
std::optional<OtherHello> decode_other_hello(const Bytes& cdr);

}  // namespace fleetmap::bus
