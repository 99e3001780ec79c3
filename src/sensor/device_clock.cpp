#include "fleetmap/sensor/device_clock.hpp"

#include <algorithm>

namespace fleetmap::sensor {
namespace {

/// Clocks of 50 ppm drift apart by 1.5 ms in that time.
constexpr Duration kRoundTripsKept = std::chrono::seconds(30);
/// An answer that took longer is less exact than the lag of messages.
constexpr Duration kMaxRoundTrip = std::chrono::milliseconds(100);

}  // namespace

bool DeviceClock::add(Duration device, Stamp arrival) {
  const bool stepped = envelope_.add(Stamp(device), arrival);
  if (stepped) round_trips_.clear();
  while (!round_trips_.empty() && arrival - round_trips_.front().received > kRoundTripsKept)
    round_trips_.pop_front();
  return stepped;
}

void DeviceClock::add_round_trip(Stamp sent, Duration device, Stamp received) {
  const Duration length = received - sent;
  if (length < Duration::zero() || length > kMaxRoundTrip) return;
  round_trips_.push_back({received, (sent - Stamp(device)) + length / 2, length});
}

const DeviceClock::RoundTrip* DeviceClock::shortest() const {
  const auto found = std::ranges::min_element(round_trips_, {}, &RoundTrip::length);
  return found == round_trips_.end() ? nullptr : &*found;
}

std::optional<Stamp> DeviceClock::to_system(Duration device) const {
  if (const RoundTrip* best = shortest()) return Stamp(device) + best->lag;
  if (envelope_.empty()) return std::nullopt;
  return Stamp(device) + from_seconds(envelope_.min());
}

std::optional<Duration> DeviceClock::uncertainty() const {
  const RoundTrip* best = shortest();
  return best ? std::optional(best->length / 2) : std::nullopt;
}

}  // namespace fleetmap::sensor
