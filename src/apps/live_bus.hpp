#pragma once

#include <memory>

#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::apps {

/// DdsBus::create, with its warnings in the log.
Result<std::unique_ptr<bus::DdsBus>> join_dds(const bus::DdsBusConfig& config);

}  // namespace fleetmap::apps
