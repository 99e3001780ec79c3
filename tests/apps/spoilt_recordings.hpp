#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/frame_tree.hpp"

namespace fleetmap::testing {

/// A sample and when it was recorded.
struct Recorded {
  recording::Sample sample;
  Stamp received;
  Bytes cdr = {};          ///< in place of the sample's own encoding, if it is not empty
  std::string topic = {};  ///< in place of that of its type, if it is not empty
};
using Recording = std::vector<Recorded>;

/// A way in which drivers, cables and clocks spoil a recording.
struct Spoilt {
  std::string name;
  std::function<void(Recording&)> spoil;
  /// Part of the sentence that names the cause; empty: it must do no harm.
  std::string named;
  bool in_place = false;   ///< it spoils the place on the Earth, not the odometry
  bool corrected = false;  ///< it is named and must do no harm either
};

/// As `Spoilt` of one type of sample: a change of each.
template <class T>
std::function<void(Recording&)> each(std::function<void(T&)> change) {
  return [change](Recording& recording) {
    for (Recorded& one : recording) {
      if (auto* sample = std::get_if<T>(&one.sample)) change(*sample);
    }
  };
}

/// The table.
std::vector<Spoilt> spoilt_recordings();

}  // namespace fleetmap::testing
