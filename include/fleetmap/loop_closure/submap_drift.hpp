#pragma once

#include "fleetmap/graph/node.hpp"
#include "fleetmap/registration/map_drift.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::loop_closure {

/// Uncertainty of the inner shape of the spherized cloud around `node`: its stops are those of
/// path_segment_around(), with the odometry's own covariances between them. Works for other robots' nodes as
/// well; where some are not held, odometry is taken to err over the gap as registration::MapDrift::straight()
/// has it.
registration::MapDrift drift_around(const store::Store& store, const graph::Node& node, double reach);

}  // namespace fleetmap::loop_closure
