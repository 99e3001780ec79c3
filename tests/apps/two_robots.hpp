#pragma once

#include "fleetmap/core/ids.hpp"

namespace fleetmap::apps {

inline const AgentId kR1 = AgentId::parse("r1").value(), kR2 = AgentId::parse("r2").value();

}  // namespace fleetmap::apps
