#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "commands.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/recording/log_clock.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// The options of commands that read one recording.
struct RecordingOptions {
  std::string recording;
  std::string config;
  std::vector<std::string> set;
  bool scans_needed = true;  ///< no option: what the command cannot do without
};
void add_recording_options(CLI::App& command, RecordingOptions& options);

/// Facts about a recording that its samples are read by.
struct Preparation {
  recording::LogClock log_clock;
  std::vector<std::string> mounts;    ///< a line for each sensor
  std::vector<std::string> findings;  ///< a sentence on each fault
};
/// Examines a recording's beginning, and completes the robot's settings by mounts and units that it states.
Result<Preparation> prepare(const std::filesystem::path& recording, const recording::ReaderConfig& reader,
                            agent::PerceptionConfig& config);

/// An opened recording and the settings of the robot that it is of.
struct RecordingInput {
  config::RobotConfig config;
  std::unique_ptr<recording::Reader> reader;
  Preparation prepared;
};
/// Fails with the exit code after the reason was reported.
tl::expected<RecordingInput, int> open_recording(const RecordingOptions& options);

}  // namespace fleetmap::apps
