#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

/// The evidence against the items of one agent.
struct Contradiction {
  std::size_t alignments = 0;  ///< rejected ones between it and the agents below
  std::set<AgentId> with;      ///< agents whose alignments with it are mostly rejected
  std::size_t steps = 0;       ///< steps of its odometry that its own fixes contradict, or that are too fast
  std::size_t impossible = 0;  ///< nodes and alignments with impossible numbers
};

/// "9 alignments with r1, r2 are rejected; 5 steps of its odometry are impossible or contradict its fixes"
std::string to_string(const Contradiction& contradiction);

/// Agents that contradict the fleet, by the placement (method `graph`) of these nodes: those whose alignments
/// with two or more others are mostly rejected, the agent with the most such others first and the rest
/// counted without it; those whose odometry and fixes often contradict each other; and those whose items
/// have impossible numbers. Two agents whose alignments are rejected between them alone are both left out,
/// because either may be the cause.
std::map<AgentId, Contradiction> contradict_the_fleet(const Placement& placement, std::span<const Node> nodes,
                                                      const LocalFrame& site);

}  // namespace fleetmap::graph
