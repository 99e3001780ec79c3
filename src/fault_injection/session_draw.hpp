#pragma once

#include <cstdint>

#include "draws.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::fault_injection {

/// Begins a session of the store's agent with a number from `draws`, as agent::Agent does.
Result<std::uint16_t> draw_session(store::Store& store, Draws& draws);

}  // namespace fleetmap::fault_injection
