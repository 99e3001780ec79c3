#pragma once

#include <vector>

#include "support/robots.hpp"

namespace fleetmap::fault_injection {

const std::vector<AgentId> kFleet{fleetmap::testing::kSelf, fleetmap::testing::kPeer,
                                  fleetmap::testing::kThird};
inline constexpr Stamp kNow = fleetmap::testing::kStart;

}  // namespace fleetmap::fault_injection
