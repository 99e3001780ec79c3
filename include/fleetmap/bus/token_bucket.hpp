#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// Bytes on the wire of one RTPS message beside its payload: 28 of IPv4 and UDP, and 132 as seen on the wire
/// of Debian's Fast DDS 2.9.1: RTPS header 20, INFO_DST 16, INFO_TS 12, DATA 24, and 60 of its statistics
/// module.
struct WireOverhead {
  std::size_t ip_udp = 28;
  std::size_t rtps = 132;
  std::size_t max_datagram_payload = 1280;  ///< larger messages travel as fragments, each with the overhead
};

/// How many datagrams `payload` bytes travel in; an empty message is still one.
std::size_t datagrams(std::size_t payload, const WireOverhead& overhead = {});
/// What `payload` bytes cost on the wire, to one receiver.
std::size_t wire_bytes(std::size_t payload, const WireOverhead& overhead = {});

/// Lets through `rate_bit_s` on average and `burst_bytes` at once. Pure: time is an argument, and time that
/// runs backwards earns nothing.
class TokenBucket {
 public:
  struct Config {
    double rate_bit_s = 160e3;       ///< bit/s, > 0
    std::size_t burst_bytes = 3000;  ///< bytes, > 0; about two full datagrams
    Status validate() const;
  };

  /// Starts full.
  TokenBucket(const Config& config, Stamp now);

  /// Pays for `bytes` if the bucket holds them. A message larger than the burst passes when the bucket is
  /// full and is paid off afterwards, so that nothing waits for ever and the rate holds.
  bool try_take(std::size_t bytes, Stamp now);
  /// How long until `try_take(bytes)` succeeds; zero if it would now.
  Duration time_until(std::size_t bytes, Stamp now) const;
  /// Bytes that may go now; negative while a large message is being paid off.
  double level(Stamp now) const;

 private:
  Config config_;
  double level_;  ///< bytes, at `updated_`
  Stamp updated_;
};

}  // namespace fleetmap::bus
