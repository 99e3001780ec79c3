#pragma once

#include <string>
#include <vector>

#include "fleetmap/bus/dds_bus_config.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::apps {

/// The robots that an operator's orders are sent to, and the DDS configuration that reaches them.
struct OperatorFleet {
  std::vector<AgentId> robots;
  bus::DdsBusConfig dds;  ///< of the operator's own participant on the long range
};

/// The robots and the DDS settings of a robot's or a fleet's file.
Result<OperatorFleet> operator_fleet(const std::string& file, const std::vector<config::Override>& overrides);

/// The robot of that name; fails if there is none. `file`: as the error names it.
Result<AgentId> robot_named(const OperatorFleet& fleet, const std::string& name, const std::string& file);

}  // namespace fleetmap::apps
