#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <variant>

#include "fleetmap/core/time.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// Describes the times at which a recording's samples were recorded.
struct LogClock {
  /// The times run as the sensors' stamps do, so that a sensor's offset shows against them. False for a
  /// simulator that was slower than real time, a bag that was recorded from one played at another rate, and
  /// times that do not advance; then samples are played at their stamps.
  bool usable = true;
  /// To the time of the drive, for a recording that was written again later.
  Duration shift{};
};

/// Finds it from the first 20 s of a recording.
class LogClockFinder {
 public:
  /// False when it has seen enough.
  bool add(const Sample& sample, Stamp recorded);
  /// Without a sample, the clock of a recording that is played by its stamps.
  LogClock clock() const;

  /// Times of one kind of sensor.
  struct Times {
    Stamp first_stamp, last_stamp, first_recorded, last_recorded;
    Duration min_lag = Duration::max();
  };

 private:
  std::array<std::optional<Times>, std::variant_size_v<Sample>> times_;
  std::optional<Stamp> begun_;
  std::size_t samples_ = 0;
};

}  // namespace fleetmap::recording
