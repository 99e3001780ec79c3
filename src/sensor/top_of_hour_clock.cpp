#include "fleetmap/sensor/top_of_hour_clock.hpp"

#include <algorithm>

namespace fleetmap::sensor {
namespace {

constexpr Duration kHour = std::chrono::hours(1);
/// Device and arrival advance alike from packet to packet, but for queues and drift.
constexpr Duration kStep = std::chrono::seconds(5);
/// Arrivals as files state them may be anything; sums of these do not overflow.
constexpr Stamp kEarliest = stamp_from_ns(0), kLatest = stamp_from_ns(4'000'000'000'000'000'000);

/// The time nearest to another that lies at a place within the hour.
Stamp nearest_within_hour(Stamp time, Duration within_hour) {
  Duration ahead = (within_hour - time.time_since_epoch()) % kHour;
  if (ahead > kHour / 2) ahead -= kHour;
  if (ahead <= -kHour / 2) ahead += kHour;
  return time + ahead;
}

Duration magnitude(Duration duration) { return duration < Duration::zero() ? -duration : duration; }

}  // namespace

TopOfHourClock::Reading TopOfHourClock::read(std::uint32_t microseconds, Stamp arrival) {
  arrival = std::clamp(arrival, kEarliest, kLatest);
  const Duration within_hour = std::chrono::microseconds(microseconds);
  Reading reading;
  if (last_) {
    // From the time before, since half an hour from the arrival either hour is the nearer one now and then.
    reading.device = nearest_within_hour(last_->device + (arrival - last_->arrival), within_hour);
    reading.restarted = magnitude((reading.device - last_->device) - (arrival - last_->arrival)) > kStep;
  }
  if (!last_ || reading.restarted) {
    reading.device = nearest_within_hour(arrival, within_hour);
    lag_ = {};
    synchronised_ = magnitude(arrival - reading.device) <= kSynchronised;
  }
  lag_.add(reading.device, arrival);
  last_ = {reading.device, arrival};
  return reading;
}

Duration TopOfHourClock::offset() const {
  return synchronised_ || lag_.empty() ? Duration::zero() : from_seconds(lag_.min());
}

}  // namespace fleetmap::sensor
