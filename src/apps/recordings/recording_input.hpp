#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command_result.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/recording/log_clock.hpp"
#include "fleetmap/recording/reader.hpp"
#include "recording_options.hpp"

namespace fleetmap::apps {

/// Facts about a recording that its samples are read by.
struct Preparation {
  recording::LogClock log_clock;
  std::vector<std::string> mounts;    ///< a line for each sensor
  std::vector<std::string> findings;  ///< a sentence on each fault
};
/// Examines a recording's beginning, and completes the robot's settings by mounts and units that it states.
Result<Preparation> prepare(const std::filesystem::path& recording, const recording::ReaderConfig& reader,
                            agent::PerceptionConfig& config);
/// Logs mounts and findings; `source`: the robot that the recording is of, empty if there is only one.
void log_preparation(const Preparation& prepared, const std::string& source = {});

/// An opened recording and the settings of the robot that it is of.
struct RecordingInput {
  config::RobotConfig config;
  std::unique_ptr<recording::Reader> reader;
  Preparation prepared;
};
CommandResult<RecordingInput> open_recording(const RecordingOptions& options);

}  // namespace fleetmap::apps
