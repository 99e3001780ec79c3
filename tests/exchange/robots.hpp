#pragma once

#include "store/items.hpp"

namespace fleetmap::exchange {

/// The robot under test, two others of its fleet, and one of another fleet.
inline const AgentId kSelf = testing::agent("r1"), kPeer = testing::agent("r2"),
                     kThird = testing::agent("r3"), kStranger = testing::agent("x");
/// The robot that made the items that kPeer holds.
inline const AgentId kMaker = kThird;
/// The time at which tests start.
inline constexpr Stamp kStart = stamp_from_ns(1'700'000'000'000'000'000);

}  // namespace fleetmap::exchange
