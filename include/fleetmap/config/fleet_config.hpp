#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/dds_bus_config.hpp"
#include "fleetmap/bus/local_network_config.hpp"
#include "fleetmap/config/field_config.hpp"
#include "fleetmap/config/recording_config.hpp"
#include "fleetmap/config/twin_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/planning/mission/mission_config.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_output/ros_output_config.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/robot_twin_config.hpp"

/// The only place that reads YAML configurations. Every problem is reported with file, line and key, all at
/// once.
namespace fleetmap::config {

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
    ros_output::RosOutputConfig ros;
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
  double exchange_timeout =
      120.0;  ///< s of virtual time that the exchange may take after the last sensor sample
};

}  // namespace fleetmap::config
