#pragma once

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::testing {

/// The robot under test, and two others of its fleet. Not inline: clang may initialise inline variables after
/// those of a test that are made of them.
const AgentId kSelf = AgentId::parse("r1").value(), kPeer = AgentId::parse("r2").value(),
              kThird = AgentId::parse("r3").value();
/// The time at which tests start.
inline constexpr Stamp kStart = stamp_from_ns(1'700'000'000'000'000'000);

}  // namespace fleetmap::testing
