#pragma once

#include <map>
#include <set>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/store/store.hpp"
#include "membership.hpp"
#include "neighbour_table.hpp"

namespace fleetmap::exchange {

/// Nodes whose submaps this robot does not hold, and whether any robot can still deliver them.
class MissingSubmaps {
 public:
  void add(const NodeId& node, Stamp now) { since_[node] = now; }
  void remove(const NodeId& node) { since_.erase(node); }

  /// Every submap is held, but for those that all other robots have denied to hold, and those made by the
  /// robots in `without`, which are lost, that no other robot holds.
  bool complete(const store::Store& store, const Membership& members, const NeighbourTable& neighbours,
                const std::set<AgentId>& without) const;

 private:
  /// All other robots have sent digests without this submap since its node was stored.
  bool is_denied(const NodeId& node, const Membership& members, const NeighbourTable& neighbours,
                 const std::set<AgentId>& without) const;

  std::map<NodeId, Stamp> since_;  ///< when the node was stored
};

}  // namespace fleetmap::exchange
