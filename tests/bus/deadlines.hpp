#pragma once

#include "bus/dds/executor.hpp"

namespace fleetmap::bus::testing {

/// Deadlines of Executor::run_one: only work that is queued already; as long as it takes.
inline constexpr auto kAtOnce = Executor::Clock::time_point::min();
inline constexpr auto kAtLast = Executor::Clock::time_point::max();

}  // namespace fleetmap::bus::testing
