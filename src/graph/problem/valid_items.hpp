#pragma once

#include <span>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

/// Items in an order that depends on the set alone. The pointers refer to the caller's spans.
struct SortedItems {
  std::vector<const Node*> nodes;            ///< valid ones, by id
  std::vector<const Alignment*> alignments;  ///< by (computed_by, seq)
};

/// Nodes with non-finite or impossible numbers are left out: coordinates beyond 1000 km, matrices that are no
/// rotation or no covariance.
SortedItems sorted_items(std::span<const Node> nodes, std::span<const Alignment> alignments,
                         const LocalFrame& site);

/// `invalid` if its numbers are impossible, `waiting` if one of its nodes is missing, else `undecided`.
AlignmentStatus initial_status(const Alignment& alignment, const std::vector<const Node*>& sorted_nodes);

}  // namespace fleetmap::graph
