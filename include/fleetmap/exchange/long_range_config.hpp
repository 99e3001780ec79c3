#pragma once

#include <cstddef>

#include "fleetmap/core/result.hpp"
#include "fleetmap/exchange/pace_config.hpp"

namespace fleetmap::exchange {

/// Configuration of the long-range link.
struct LongRangeConfig {
  /// B/s that all agents together send: 145 kbit/s in the mean, and 160 of the radio's 200 in any second.
  double fleet_bytes_per_second = 18'125;
  PaceConfig pace;
  double small_reserve_bytes = 300;  ///< B, left by backfill and clouds so that a small message goes at once
  std::size_t overhead_bytes =
      114;  ///< B a message, as captured: 14 of Ethernet, 28 of IP and UDP, 72 of RTPS
  bool deliver_to_one =
      true;                ///< a message with a recipient goes to it alone; false: every agent gets a copy
  bool multicast = false;  ///< a message to all is one on the medium; false: one for each other agent
  std::size_t max_small = 512;  ///< messages waiting in each of the classes safety, control, news and state
  std::size_t max_backfill = 512;   ///< messages
  std::size_t max_fragments = 512;  ///< messages
  Status validate() const;
  /// Number of times that a message to all crosses the medium.
  std::size_t copies(std::size_t fleet_size) const {
    return multicast || fleet_size < 2 ? 1 : fleet_size - 1;
  }
};

}  // namespace fleetmap::exchange
