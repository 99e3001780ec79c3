#pragma once

#include <vector>

#include "store/items.hpp"

namespace fleetmap::fault_injection {

inline const std::vector<AgentId> kFleet{fleetmap::testing::agent("r1"), fleetmap::testing::agent("r2"),
                                         fleetmap::testing::agent("r3")};
inline constexpr Stamp kNow = stamp_from_ns(1'700'000'000'000'000'000);

}  // namespace fleetmap::fault_injection
