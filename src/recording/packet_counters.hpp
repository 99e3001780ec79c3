#pragma once

#include <cstdint>

#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/packet_refusal.hpp"

namespace fleetmap::recording {

/// The counter of packets that are refused for a reason.
std::uint64_t Counters::*counter_of(sensor::PacketFault fault);

inline constexpr char kIncompleteSweep[] = "a part of a turn without beginning or end is left out";
inline constexpr char kCutDatagrams[] =
    "datagrams are cut or lack fragments; capture whole frames (tcpdump -s 0), filtered by host, not by port";

}  // namespace fleetmap::recording
