#pragma once

#include "fleetmap/core/time.hpp"

namespace fleetmap::fault_injection {

inline constexpr Duration kTick = std::chrono::milliseconds(100);  ///< of a simulated fleet

}  // namespace fleetmap::fault_injection
