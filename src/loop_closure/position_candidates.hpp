#pragma once

#include <map>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/place/ball_tree.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::loop_closure {

/// Candidates with other robots by position: minimal proximity search (Alg. 2) in a ball tree a robot. Both
/// robots find the same pair from the same nodes.
class PositionCandidates {
 public:
  PositionCandidates(const AgentId& self, const place::ProximityConfig& config)
      : self_(self), config_(config) {}

  /// Adds a node that has a usable G. Returns, of each robot that it may pair with, the nearest node within
  /// r^i of Eq. 1: an own node is compared with all peers, a peer's node with ours.
  std::vector<LoopCandidate> propose(const graph::Node& node);

 private:
  struct Track {
    place::BallTree tree;
    std::vector<NodeId> ids;  ///< by index in the tree
  };
  AgentId self_;
  place::ProximityConfig config_;
  std::map<AgentId, Track> tracks_;
};

}  // namespace fleetmap::loop_closure
