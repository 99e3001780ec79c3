#pragma once

#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/store_config.hpp"

namespace fleetmap::store {

/// Checks that the numbers of an item are finite, its poses rotations and its covariances positive, so that
/// the graph can compute with it. Signatures and the submap's bytes are checked elsewhere.
bool is_valid(const graph::Node& node, const StoreConfig& config);
bool is_valid(const graph::Alignment& alignment);

}  // namespace fleetmap::store
