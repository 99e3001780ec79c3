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

/// Pairs by the place of their own node, in cubes on Earth and in its odometry frame, so that those near a
/// node are found without a visit to all.
class CandidateGrid {
 public:
  /// `cell_m`: no search goes farther. `nodes` outlives this.
  CandidateGrid(double cell_m, const NodeIndex& nodes) : cell_m_(cell_m), nodes_(nodes) {}

  /// Its own node may come later: on_node().
  void add(const NodePair& pair);
  void erase(const NodePair& pair);
  void on_node(const NodeId& node);
  /// In order, of the pairs whose own node is nearer to `node` than a cell all, and some others.
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
