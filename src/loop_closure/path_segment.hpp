#pragma once

#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::loop_closure {

/// The nodes of one pass of the robot by the node: in the same odometry frame, in order, from `reach` m of
/// path before it to `reach` m after it. A spherized cloud is made of one pass only: with submaps of other
/// passes two clouds of one robot would share submaps, and their registration would repeat the odometry's
/// error instead of measuring it.
std::vector<const graph::Node*> path_segment_around(const store::Store& store, const graph::Node& node,
                                                    double reach);

}  // namespace fleetmap::loop_closure
