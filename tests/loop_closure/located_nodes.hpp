#pragma once

#include "store/items.hpp"

namespace fleetmap::loop_closure {

/// A node with GPS of 0.1 m: its search radius is r_min = 20 m.
inline graph::Node node_at(const AgentId& agent, std::uint32_t seq, double east_m) {
  auto node = testing::make_node(agent, seq, Bytes{}, east_m);
  node.G->covariance = 0.01 * Matrix6d::Identity();
  return node;
}

}  // namespace fleetmap::loop_closure
