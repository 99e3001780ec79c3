#pragma once

#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::loop_closure {

/// Where the node's robot drove as it passed the node: nodes of the same odometry frame, in their order, from
/// `reach` m of path before it to `reach` m after it. A spherized cloud is made of one pass alone: with what
/// the robot saw when it came by at another time, two clouds of one robot would share submaps, and their
/// registration would say again what its odometry said.
std::vector<const graph::Node*> pass_around(const store::Store& store, const graph::Node& node, double reach);

}  // namespace fleetmap::loop_closure
