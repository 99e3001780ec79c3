#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/bus/fleet_settings.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// fleetmap::msg::Introduction: a robot that the sender of a Hello knows.
struct Introduction {
  std::array<std::uint8_t, 12> prefix{};  ///< RTPS, of its participant
  AgentId agent;
  std::array<std::uint8_t, 4> address{};
  std::uint16_t port = 0;
  Duration heard_ago{};   ///< since a Hello of the robot itself was received, to 0.1 s, at most 6553 s
  Duration joined_ago{};  ///< since the robot joined, to 1 s, at most 255 s
  bool operator==(const Introduction&) const = default;
};

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
  Duration joined_ago{};                  ///< since the sender joined, to 1 s, at most 255 s
  std::uint8_t seeks = 0;                 ///< robots of its configuration that the sender does not know
  std::vector<Introduction> introduces;  ///< at most kMaxIntroductions, with the sender's settings and topics
};
inline constexpr std::size_t kMaxReads = 64;
inline constexpr std::size_t kMaxIntroductions = 32;  // a Hello is one IP packet

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
