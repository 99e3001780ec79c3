#pragma once

#include <filesystem>

#include "fleetmap/bus/dds_bus_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `dds`: domains, addresses, peers.
void read_dds(Section& top, bus::DdsBusConfig& dds);
/// Checks that `folder` holds the profiles of all links, which an agent reads when it starts.
void check_profiles(Section& dds, const std::filesystem::path& folder);

}  // namespace fleetmap::config
