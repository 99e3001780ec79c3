#pragma once

#include <optional>

#include "fleetmap/config/fleet_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// The keys that describe one agent, at the top of AGENT.yaml or in a list entry of FLEET.yaml (laid on
/// `defaults`).
void read_agent(Section& top, agent::AgentConfig& agent);
/// `recording`: where the sensor samples come from.
std::optional<RecordingConfig> read_recording(Section& top);
/// `dds`: domains, addresses, peers.
void read_dds(Section& top, bus::DdsBusConfig& dds);
/// `keys`: the robot's folder of keys, or in a fleet's file the folder that holds one for each robot.
void read_keys(Section& top, bool of_fleet, agent::AgentConfig& agent, bus::DdsBusConfig& dds);
/// `network`: the simulated radios of a run in virtual time.
void read_network(Section& top, bus::LocalNetworkConfig& network, std::vector<RadioBlackout>& blackouts);

}  // namespace fleetmap::config
