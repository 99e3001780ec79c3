#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <vector>

#include "command_result.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/recording/reader_config.hpp"
#include "replay_options.hpp"

namespace fleetmap::apps {

/// A recording, and the robot on whose onboard link it stands for the sensors.
struct Replay {
  config::RobotConfig robot;
  std::filesystem::path recording;
  recording::ReaderConfig reader;
};

/// Reads the robot's file. Fails without a recording.
CommandResult<Replay> replay_of(const ReplayOptions& options);

/// Fails if nobody reads one of the topics of the sensors that the robot uses: no agent is there, or it names
/// the topic otherwise. `readers` of each of sensor_topics().
Status check_readers(const config::RobotConfig& robot, const std::vector<std::size_t>& readers);

/// Waits for an agent that listens, then plays the recording to its end or until a signal. Prints to `out`
/// how many samples were played and left out.
CommandResult<ExitCode> replay_recording(const ReplayOptions& options, std::ostream& out);

}  // namespace fleetmap::apps
