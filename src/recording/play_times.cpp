#include "fleetmap/recording/play_times.hpp"

namespace fleetmap::recording {

Stamp PlayTimes::of(const Sample& sample, std::optional<Stamp> recorded) {
  const Stamp stamp = stamp_of(sample);
  if (recorded && log_clock_.usable) return *recorded + log_clock_.shift;
  Clock& clock = clocks_[sample.index()];
  // The reader returns no other samples that are earlier than the one before.
  if (clock.last && stamp < *clock.last) clock.set_back += *clock.last - stamp;
  clock.last = stamp;
  return stamp + clock.set_back;
}

}  // namespace fleetmap::recording
