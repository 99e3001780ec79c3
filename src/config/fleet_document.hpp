#pragma once

#include "fleetmap/config/fleet_config.hpp"
#include "yaml_document.hpp"

namespace fleetmap::config {

/// The fleet of a document of FLEET.yaml.
Result<FleetConfig> read_fleet(Document& document);

}  // namespace fleetmap::config
