#pragma once

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording::testing {

/// Stamp of a recording's first sample.
inline const Stamp kBegin = stamp_from_ns(1'700'000'000'000'000'000);

/// An empty sample of a sensor, `time` after the first.
template <class T>
Sample at(Duration time) {
  T sample;
  sample.stamp = kBegin + time;
  return sample;
}

}  // namespace fleetmap::recording::testing
