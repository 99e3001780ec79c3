#include "fleetmap/recording/play_times.hpp"

namespace fleetmap::recording {
namespace {

/// A bag that was written again long after the drive is played at the time of the drive.
constexpr Duration kSameDay = std::chrono::hours(24);
/// Stamps before this count from the start of a sensor.
constexpr Stamp kOldestClock{std::chrono::days(10 * 365)};

Duration shift_of(Stamp stamp, Stamp recorded) {
  const Duration behind = recorded - stamp;
  const bool same_day = behind < kSameDay && behind > -kSameDay;
  return same_day || stamp < kOldestClock ? Duration::zero() : -behind;
}

}  // namespace

Stamp PlayTimes::of(const Sample& sample, std::optional<Stamp> recorded) {
  const Stamp stamp = stamp_of(sample);
  if (recorded) {
    if (!shift_) shift_ = shift_of(stamp, *recorded);
    return *recorded + *shift_;
  }
  Clock& clock = clocks_[sample.index()];
  // The reader gives out no other samples that are earlier than the one before.
  if (clock.last && stamp < *clock.last) clock.set_back += *clock.last - stamp;
  clock.last = stamp;
  return stamp + clock.set_back;
}

}  // namespace fleetmap::recording
