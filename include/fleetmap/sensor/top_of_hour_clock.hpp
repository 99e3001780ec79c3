#pragma once

#include <cstdint>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/min_lag_filter.hpp"

namespace fleetmap::sensor {

/// Clock of a device that counts microseconds within the hour, resolved by the times at which its packets
/// arrive. A device that GPS synchronises counts within the hour of UTC; its times are taken as they are. Any
/// other counts from when it was switched on; the least lag of its packets moves its times onto the clock of
/// their arrival.
class TopOfHourClock {
 public:
  /// Offset up to which a device counts as synchronised, as found by its first packet.
  static constexpr Duration kSynchronised = std::chrono::seconds(1);

  struct Reading {
    Stamp device;            ///< by the device's own clock, in the hour nearest to the arrival
    bool restarted = false;  ///< the clock made a step, as when the device was switched on again
  };
  Reading read(std::uint32_t microseconds, Stamp arrival);

  /// To be added to Reading::device.
  Duration offset() const;
  bool synchronised() const { return synchronised_; }

 private:
  struct Last {
    Stamp device, arrival;
  };
  std::optional<Last> last_;
  MinLagFilter lag_;
  bool synchronised_ = false;
};

}  // namespace fleetmap::sensor
