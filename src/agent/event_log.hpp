#pragma once

#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/exchange.hpp"

namespace fleetmap::agent {

/// Tells people what robot `self` heard of the fleet: what they should look at as a warning or an error, the
/// rest for debugging.
void log_event(const AgentId& self, const exchange::Event& event);

}  // namespace fleetmap::agent
