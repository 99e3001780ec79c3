#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
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

/// Reads the stamps of the first 20 s of a recording, whose scans are not decoded for it. Without such times
/// it is played by its stamps.
Result<LogClock> find_log_clock(const std::filesystem::path& recording, const ReaderConfig& config = {});

}  // namespace fleetmap::recording
