#pragma once

#include "store_state.hpp"

namespace fleetmap::store {

/// Adds a node; own nodes come with their `submap`, others without (null). A second content makes the name
/// contested.
Result<Put> put_node(StoreState& s, const graph::Node& node, const ByteView* submap);
Result<Put> put_alignment(StoreState& s, const graph::Alignment& alignment);

}  // namespace fleetmap::store
