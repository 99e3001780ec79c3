#pragma once

#include "store/items.hpp"
#include "support/robots.hpp"

namespace fleetmap::testing {

/// Two robots whose maps are merged.
inline const AgentId kA = agent("a"), kB = agent("b");

}  // namespace fleetmap::testing
