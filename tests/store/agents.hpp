#pragma once

#include "store/items.hpp"

namespace fleetmap::testing {

/// The owner of the store under test, and another robot of its fleet.
inline const AgentId kSelf = agent("r1"), kPeer = agent("r2");

/// Two robots whose maps are merged.
inline const AgentId kA = agent("a"), kB = agent("b");

}  // namespace fleetmap::testing
