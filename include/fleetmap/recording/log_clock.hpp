#pragma once

#include <filesystem>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// What the times at which a recording's samples were recorded are good for.
struct LogClock {
  /// They run as the sensors' stamps do: what one sensor is off shows against them. False for a simulator
  /// that was slower than real time, a bag that was recorded anew from one played at another rate, and times
  /// that stand still; then samples are played at their stamps.
  bool usable = true;
  /// To the time of the drive, for a recording that was written again later.
  Duration shift{};
};

/// Looks at the first 20 s of a recording. One without such times is never played by them.
Result<LogClock> find_log_clock(const std::filesystem::path& recording, const ReaderConfig& config = {});

}  // namespace fleetmap::recording
