#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::apps {

/// DdsBus::create, with its warnings in the log.
Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config);

/// `wanted` (at most 8 characters), or else a name like it that no robot has.
AgentId free_name(const std::string& wanted, const std::vector<AgentId>& robots);

}  // namespace fleetmap::apps
