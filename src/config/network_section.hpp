#pragma once

#include <vector>

#include "fleetmap/bus/local_network_config.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `network`: the simulated radios of a run in virtual time.
void read_network(Section& top, bus::LocalNetworkConfig& network, std::vector<RadioBlackout>& blackouts);

}  // namespace fleetmap::config
