#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/bus/local_bus.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/reader.hpp"

/// The only place that reads YAML configurations. Every problem is reported with file, line and key, all at
/// once.
namespace fleetmap::config {

/// --set key=value: replaces a key wherever it may stand; problems with it are reported as "--set key".
struct Override {
  std::string key;    ///< dotted: lidar.translation
  std::string value;  ///< YAML: [0, 0, 0.35]
};
/// "key=value" of a command line.
Result<Override> parse_override(const std::string& text);

struct RecordingConfig {
  std::filesystem::path path;
  recording::ReaderConfig reader;
  /// s, when the recording's first sample is played, counted from the start of the run. Empty: recordings
  /// that began within an hour of each other keep their times, others all start at 0.
  std::optional<double> start;
};

/// One robot over DDS: AGENT.yaml.
struct RobotConfig {
  agent::AgentConfig agent;
  bus::DdsBusConfig dds;
  std::optional<RecordingConfig> recording;
};

/// A whole fleet in one process: FLEET.yaml.
struct FleetConfig {
  struct Member {
    agent::AgentConfig agent;
    RecordingConfig recording;
  };
  std::vector<Member> members;
  bus::LocalNetworkConfig network;
  double settle_time = 120.0;  ///< s of virtual time that the exchange may take after the last sensor sample
};

Result<RobotConfig> load_robot(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// Agents' directories are left empty.
Result<FleetConfig> load_fleet(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// A fleet with default settings (VLP-16), one agent a recording.
Result<FleetConfig> fleet_of(const std::vector<std::pair<AgentId, std::filesystem::path>>& recordings,
                             const std::vector<Override>& overrides);
/// The sensor and odometry settings alone, from an agent's or a fleet's file (its first agent) or, without a
/// file, the defaults.
Result<RobotConfig> load_sensors(const std::optional<std::filesystem::path>& file,
                                 const std::vector<Override>& overrides);

enum class FileKind { kRobot, kFleet };
/// What `fleetmap check-config` does: loads `file` as what it is.
Result<FileKind> check(const std::filesystem::path& file, const std::vector<Override>& overrides);

}  // namespace fleetmap::config
