#pragma once

#include <map>
#include <string>
#include <vector>

#include "fleetmap/fault_injection/exchange_fleet.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::fault_injection {

using Robots = std::map<AgentId, ExchangeFleet::Robot>;

/// The first reason why the stores and exchanges of the robots, at least one, are not equal and idle; empty
/// if they are.
std::string why_not_converged(const Robots& robots, Stamp now);
/// The first robot whose exchange lacks an item; empty if none does.
std::string why_incomplete(const Robots& robots, Stamp now);

graph::Placement placement_of(const ExchangeFleet::Robot& robot, const LocalFrame& site);

struct MapDifference {
  AgentId robot;
  std::string what;
};
/// Robots whose placement or merged map is not that of the first robot, bit for bit.
std::vector<MapDifference> map_differences(const Robots& robots, const LocalFrame& site);

}  // namespace fleetmap::fault_injection
