#pragma once

#include "store/items.hpp"
#include "support/robots.hpp"

namespace fleetmap::exchange {

using testing::kPeer;
using testing::kSelf;
using testing::kStart;
using testing::kThird;

/// A robot of another fleet.
const AgentId kStranger = testing::agent("x");
/// The robot that made the items that kPeer holds.
const AgentId kMaker = kThird;

}  // namespace fleetmap::exchange
