#pragma once

#include <deque>
#include <optional>

#include "fleetmap/core/time.hpp"
#include "fleetmap/sensor/min_lag_filter.hpp"

namespace fleetmap::sensor {

/// Maps the time of a device, counted from its start, to this computer's clock. It uses the shortest of the
/// last round trips, as NTP does, or, if the device does not answer, the least lag of its messages, which
/// includes their time of transmission.
class DeviceClock {
 public:
  /// True when the device's clock made a step, as when it was switched on again: what was learnt is
  /// forgotten.
  bool add(Duration device, Stamp arrival);
  /// The device stamped with `device` its answer to what was sent at `sent`.
  void add_round_trip(Stamp sent, Duration device, Stamp received);
  /// Empty before the first time of the device.
  std::optional<Stamp> to_system(Duration device) const;
  /// By how much to_system() may be wrong, if round trips tell: half of the shortest one.
  std::optional<Duration> uncertainty() const;

 private:
  struct RoundTrip {
    Stamp received;
    Duration lag{}, length{};
  };
  const RoundTrip* shortest() const;

  MinLagFilter envelope_;
  std::deque<RoundTrip> round_trips_;
};

}  // namespace fleetmap::sensor
