#pragma once

#include <set>

#include "graph/placed_fleet.hpp"

namespace fleetmap::graph::testing {

inline const AgentId kR4 = SimulatedFleet::agent(3);

/// All alignments of two robots see the second one displaced (ENU, m).
inline void displace(SimulatedFleet& fleet, const AgentId& first, const AgentId& second,
                     const Eigen::Vector3d& shift) {
  for (Alignment& a : fleet.alignments) {
    if (std::set{a.i.agent, a.j.agent} != std::set{first, second}) continue;
    Pose T = fleet.truth.at(a.j);
    T.pretranslate(a.j.agent == second ? shift : Eigen::Vector3d(-shift));
    a.modes = {fleet.observed_at(a.i, T)};
  }
}

/// Four robots that all meet. r4 states no position of its own and, for `metres` > 0, its clouds lie that far
/// off, in another direction for each of the others.
inline SimulatedFleet torn_fleet(unsigned seed, double metres) {
  SimulatedFleetConfig config;
  config.robots = 4;
  config.reach = 80.0;
  config.gps_sigma = 0.7;
  SimulatedFleet fleet(seed, config);
  for (Node& node : fleet.nodes)
    if (node.id.agent == kR4) node.G->covariance *= 1000.0;
  if (metres == 0.0) return fleet;
  displace(fleet, kR1, kR4, {metres, 0.0, 0.0});
  displace(fleet, kR2, kR4, {0.0, metres, 0.0});
  displace(fleet, kR3, kR4, {-metres, -metres, 0.0});
  return fleet;
}

}  // namespace fleetmap::graph::testing
