#pragma once

#include "store_state.hpp"

namespace fleetmap::store {

/// Store::resign().
Result<Store::Resigned> resign(StoreState& s, const Store::SignNode& node,
                               const Store::SignAlignment& alignment);

}  // namespace fleetmap::store
