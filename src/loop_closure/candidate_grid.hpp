#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "node_index.hpp"

namespace fleetmap::loop_closure {

/// Spatial index of pairs by the position of their own node, on Earth and in its odometry frame, so that the
/// pairs near a node are found without a scan of all.
class CandidateGrid {
 public:
  /// `cell_m`: no search goes farther. `nodes` outlives this.
  CandidateGrid(double cell_m, const NodeIndex& nodes) : cell_m_(cell_m), nodes_(nodes) {}

  /// The pair's own node may be added later by on_node().
  void add(const NodePair& pair);
  void erase(const NodePair& pair);
  void on_node(const NodeId& node);
  /// All pairs whose own node lies within `cell_m` of `node`, in order, and some whose own node is farther.
  std::set<NodePair> around(const NodeId& node) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  /// None: on Earth.
  using Key = std::pair<std::optional<graph::FrameId>, Cell>;
  std::vector<Key> keys_of(const NodeIndex::Entry& entry) const;

  double cell_m_;
  const NodeIndex& nodes_;
  std::map<Key, std::set<NodePair>> cells_;
  std::map<NodePair, std::vector<Key>> keys_;  ///< where each lies; none: its own node is not known yet
};

}  // namespace fleetmap::loop_closure
