#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/graph/alignment.hpp"
#include "problem/estimate.hpp"
#include "solver/graph_solver.hpp"

namespace fleetmap::graph {

/// Two odometry frames, the smaller first; equal for a loop closure. Indices in ReducedGraph::frames.
using FramePair = std::pair<std::size_t, std::size_t>;

/// One mode of one alignment, which may become a factor of the graph. At most one mode of an alignment does,
/// as in max-mixtures (Olson and Agarwal, "Inference on networks of mixtures for robust robot mapping", IJRR
/// 2013).
struct Candidate {
  std::size_t alignment = 0;  ///< index among the alignments
  std::size_t mode = 0;
  std::size_t modes = 1;  ///< of the alignment
  BetweenFactor factor;   ///< between the pose variables of i and j; covariance with the floor
  FramePair frames;
  /// +1 if moving the second frame of the pair (the later node of a loop) moves factor.b, else -1.
  double sign = 1.0;

  /// A loop closure with several modes. Wrong modes of two lanes agree with each other as well as the right
  /// ones do, because the scene repeats alike: their agreement is no evidence.
  bool is_ambiguous_loop() const { return frames.first == frames.second && modes > 1; }
};

/// Candidates are referred to by their index in the span of all of them.
using Indices = std::vector<std::size_t>;

/// Candidates of `alignments[k]` for each k in `present`, in this order. If any mode of an alignment is
/// certain to kCertainM, its modes that are not are left out, because they fit wherever the others do.
std::vector<Candidate> candidates_of(std::span<const Alignment* const> alignments,
                                     std::span<const std::size_t> present, const ReducedGraph& graph,
                                     const FleetPlacementConfig& config);

/// A solved graph: its estimate, and its factorisation there.
struct SolvedGraph {
  const GraphSolver& solver;
  const Estimate& estimate;
};

}  // namespace fleetmap::graph
