#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "commands.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/recording/play_times.hpp"
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

/// An opened recording and the settings of the robot that it is of.
struct RecordingInput {
  config::RobotConfig config;
  std::unique_ptr<recording::Reader> reader;
  recording::LogClock log_clock;
};
/// Fails with the exit code after the reason was reported.
tl::expected<RecordingInput, int> open_recording(const RecordingOptions& options);

}  // namespace fleetmap::apps
