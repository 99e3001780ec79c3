#pragma once

#include "store_state.hpp"

namespace fleetmap::store {

/// Fills the memory of `state` from its open file. Rows whose hash differs or that break a rule are dropped
/// and named in `damage`.
Status load(StoreState& state);

}  // namespace fleetmap::store
