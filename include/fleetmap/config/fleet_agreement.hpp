#pragma once

#include <string>
#include <vector>

#include "fleetmap/agent/agent_config.hpp"
#include "fleetmap/bus/dds_bus_config.hpp"
#include "fleetmap/bus/fleet_settings.hpp"

namespace fleetmap::config {

/// The settings of a robot that must equal those of the other robots.
bus::FleetSettings fleet_settings(const agent::AgentConfig& config);
/// A sentence for each radio whose `peers` are fewer than the other robots that are on it. None where peers
/// are on this machine, since any number may be there.
std::vector<std::string> peer_warnings(const bus::DdsBusConfig& dds,
                                       const exchange::ExchangeConfig& exchange);

}  // namespace fleetmap::config
