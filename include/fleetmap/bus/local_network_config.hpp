#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/bus/radio_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::bus {

/// The two simulated radios of a fleet in virtual time.
struct LocalNetworkConfig {
  RadioConfig long_range;
  RadioConfig short_range{.rate_bit_s = 15e6,
                          .delay = std::chrono::milliseconds(2),
                          .loss = 0.0,
                          .max_range = 90.0,  // C_max
                          .queue_capacity = 512,
                          .reliable_profiles = {"control", "bulk"},
                          .overhead = {}};
  std::size_t onboard_queue_capacity =
      1024;                ///< messages of one topic not yet delivered; the oldest is dropped
  std::uint64_t seed = 1;  ///< of loss
  Stamp start{};
  /// Virtual time that an item of offloaded work takes, by lane, whatever the machine needs for it.
  Duration perception_time{};
  Duration background_time{};
  /// Threads for offloaded work, beside the one that runs the events. Has no influence on what comes out.
  unsigned threads = 0;
  /// Names the field and the rule that it breaks.
  Status validate() const;
};

}  // namespace fleetmap::bus
