#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/log_clock.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sensor/frame_tree.hpp"

namespace fleetmap::recording {

/// Facts about a recording that its samples are read by.
struct Survey {
  LogClock clock;
  sensor::SensorFrames frames;
  std::optional<std::string> gyro_in_degrees;  ///< why the angular rates are taken for deg/s
};

/// Reads a recording's beginning, without its points: clock and frames of the first 20 s, and the unit of the
/// gyro from the first turns of the first 2 min. A recording without times of recording is played by its
/// stamps and is not examined.
Result<Survey> survey(const std::filesystem::path& recording, const ReaderConfig& config = {});

}  // namespace fleetmap::recording
