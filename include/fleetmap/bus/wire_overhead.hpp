#pragma once

#include <cstddef>

namespace fleetmap::bus {

/// Bytes on the wire of one RTPS message beside its payload: 28 of IPv4 and UDP, and 72 as seen on the wire
/// of Debian's Fast DDS 2.9.1: RTPS header 20, INFO_DST 16, INFO_TS 12 and DATA 24. With keys the seal's,
/// too.
struct WireOverhead {
  std::size_t ip_udp = 28;
  std::size_t rtps = 72;
  std::size_t seal = 0;
  std::size_t max_datagram_payload = 1280;  ///< larger messages travel as fragments, each with the overhead
};

/// Bytes that the seal of a fleet with keys adds to a datagram: a header of 10 and a tag of 16, without the
/// RTPS header of 20.
inline constexpr std::size_t kSealBytes = 6;

/// Overhead of a Hello: it has no INFO_DST, since its receiver is not known yet, and its seal has a header of
/// 32.
constexpr WireOverhead hello_overhead(bool sealed) {
  return {.rtps = WireOverhead{}.rtps - 16, .seal = sealed ? kSealBytes + 22 : 0};
}

/// The number of datagrams of a message of `payload` bytes; an empty message still takes one.
std::size_t datagrams(std::size_t payload, const WireOverhead& overhead = {});
/// Bytes on the wire of a message of `payload` bytes, to one receiver.
std::size_t wire_bytes(std::size_t payload, const WireOverhead& overhead = {});

}  // namespace fleetmap::bus
