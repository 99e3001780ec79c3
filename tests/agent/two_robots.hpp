#pragma once

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::agent {

/// The robot under test and another of its fleet.
inline const AgentId kSelf = AgentId::parse("r1").value(), kOther = AgentId::parse("r2").value();
/// The time at which tests start.
inline constexpr Stamp kStart = stamp_from_ns(1'750'000'000'000'000'000);

}  // namespace fleetmap::agent
