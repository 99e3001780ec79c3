#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "fleetmap/bus/dds_bus_config.hpp"
#include "fleetmap/core/ids.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// Every robot on this machine: an onboard domain each, the radios shared, all over the loopback.
struct LoopbackDomains {
  std::uint32_t base = 40;
  std::filesystem::path qos = "qos";
};
/// `dds` of a fleet's file.
LoopbackDomains read_loopback(Section& top);
/// The DDS configuration of the `index`-th robot of the fleet.
bus::DdsBusConfig dds_of(const AgentId& agent, std::size_t index, const LoopbackDomains& domains);

}  // namespace fleetmap::config
