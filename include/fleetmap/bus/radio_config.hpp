#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// One radio channel that all robots share: one datagram is in the air at a time.
struct RadioConfig {
  double rate_bit_s = 200e3;  ///< bit/s, > 0
  Duration delay =
      std::chrono::milliseconds(20);  ///< from the end of a transmission to the receiver's callback
  double loss = 0.0;                  ///< of one datagram, in [0, 1)
  double max_range = 0.0;             ///< m; 0 is unlimited
  std::size_t queue_capacity = 256;   ///< messages waiting at one robot; the oldest is dropped
  std::vector<std::string> reliable_profiles =
      {};  ///< lost datagrams of these are sent again, at the cost of air
  WireOverhead overhead;
};

}  // namespace fleetmap::bus
