#pragma once

#include <array>
#include <optional>
#include <variant>

#include "fleetmap/recording/log_clock.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// The times at which samples are played. With times of recording these are used, so that a sensor whose
/// clock is off shows it as it did live; otherwise the stamps are, and a sensor whose clock was set back
/// continues without a break.
class PlayTimes {
 public:
  explicit PlayTimes(const LogClock& log_clock = {}) : log_clock_(log_clock) {}
  /// Samples in the order in which they are played; `recorded` is Reader::recorded() of each.
  Stamp of(const Sample& sample, std::optional<Stamp> recorded);

 private:
  struct Clock {
    std::optional<Stamp> last;
    Duration set_back{};
  };
  std::array<Clock, std::variant_size_v<Sample>> clocks_;
  LogClock log_clock_;
};

}  // namespace fleetmap::recording
