#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/bus/local_bus.hpp"
#include "fleetmap/config/field_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sim/robot_twin.hpp"

/// The only place that reads YAML configurations. Every problem is reported with file, line and key, all at
/// once.
namespace fleetmap::config {

/// --set key=value: replaces a key wherever it may stand; problems with it are reported as "--set key".
struct Override {
  std::string key;    ///< dotted: lidar.translation
  std::string value;  ///< YAML: [0, 0, 0.35]
  std::string at{};   ///< file, line and key that says so, for messages; empty: a command line's --set
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

/// A robot as its own scan meets the ground and what stands there.
struct RobotShape {
  double radius = 0.35;      ///< m, around base_link
  double base_height = 0.1;  ///< m, of base_link above the ground
};

/// A mission on the drawing of a site, for a robot without a twin.
struct RobotMission {
  planning::MissionConfig settings;
  std::vector<planning::RobotAbility> fleet;  ///< of every robot; their starts are the drawing's
  RobotShape shape;                           ///< of this robot
  std::string at;                             ///< file, line and key, for messages
};

/// One robot over DDS: AGENT.yaml.
struct RobotConfig {
  agent::AgentConfig agent;
  std::optional<RobotMission> mission;
  bus::DdsBusConfig dds;
  std::optional<RecordingConfig> recording;
};

/// The digital twin of a fleet: its world, and what the robots do there.
struct TwinConfig {
  std::filesystem::path world;        ///< WORLD.yaml
  std::optional<std::uint64_t> seed;  ///< instead of the world's own; robots' seeds follow from it
  planning::MissionConfig mission;
  std::string mission_at;               ///< file, line and key, for messages
  double map_error = 0.5;               ///< m, by which the drawing that the fleet plans on is off
  std::uint32_t unknown_obstacles = 0;  ///< parked things that the drawing lacks
  double max_time = 3600.0;             ///< s of virtual time until robots that have not finished are stopped
};

/// A time in which a robot of the twin is switched off, as if its battery were out: s since the start of the
/// run.
struct SwitchedOff {
  double from = 0.0;
  std::optional<double> until;  ///< absent: it stays off
};

/// A time in which a radio passes nothing, for one robot or for all: s since the start of the run.
struct RadioBlackout {
  bus::Link link = bus::Link::kShortRange;
  double from = 0.0;
  double until = 0.0;
  std::optional<AgentId> agent;
};

/// A whole fleet: FLEET.yaml. Its robots are recordings, or those of the twin.
struct FleetConfig {
  struct Member {
    agent::AgentConfig agent;
    std::optional<RecordingConfig> recording;
    sim::RobotTwinConfig robot;
    std::string robot_at;  ///< file, line and key of it or, without it, of the agent, for messages
    std::vector<SwitchedOff> switched_off;  ///< in the order of time, apart from each other
    bus::DdsBusConfig dds;                  ///< as a process of its own
  };
  std::vector<Member> members;
  std::optional<TwinConfig> twin;
  bus::LocalNetworkConfig network;
  std::vector<RadioBlackout> blackouts;
  FieldConfig field;
  /// Leaves the first `count` robots, as if the file named no more.
  void keep_first(std::size_t count);
  double settle_time = 120.0;  ///< s of virtual time that the exchange may take after the last sensor sample
};

Result<RobotConfig> load_robot(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// Agents' directories are left empty. Robots over DDS get domains of their own, counted from
/// dds.base_domain.
Result<FleetConfig> load_fleet(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// The settings of a mission alone, from overrides of `mission.*`.
Result<planning::MissionConfig> load_mission_settings(const std::vector<Override>& overrides);
/// A fleet with default settings (VLP-16), one agent a recording.
Result<FleetConfig> fleet_of(const std::vector<std::pair<AgentId, std::filesystem::path>>& recordings,
                             const std::vector<Override>& overrides);
/// The sensor and odometry settings alone, from an agent's or a fleet's file (its first agent) or, without a
/// file, the defaults.
Result<RobotConfig> load_sensors(const std::optional<std::filesystem::path>& file,
                                 const std::vector<Override>& overrides);

/// What the other robots must have alike, of a robot's configuration.
bus::FleetSettings fleet_settings(const agent::AgentConfig& config);
/// A sentence for each radio whose `peers` are fewer than the other robots that are on it. None where peers
/// are on this machine, since any number may be there.
std::vector<std::string> peer_warnings(const bus::DdsBusConfig& dds,
                                       const exchange::ExchangeConfig& exchange);

enum class FileKind { kRobot, kFleet, kWorld, kSensor, kExperiment };
/// Loads `file` as what its keys say it is: agents, studies, kind, a LiDAR's pattern, or else one robot's.
/// Worlds are not built and fleets not planned. Overrides are for robots and fleets only.
Result<FileKind> check(const std::filesystem::path& file, const std::vector<Override>& overrides);

}  // namespace fleetmap::config
