#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solver/graph_solver.hpp"

namespace fleetmap::graph {

/// A hypothesis must be ahead of others by this, as log odds: luck decides nothing.
inline constexpr double kMargin = 3.0;

/// Two odometry frames, the smaller first; equal for a loop closure. Indices in ReducedGraph::frames.
using FramePair = std::pair<std::size_t, std::size_t>;

/// One mode of one alignment.
struct Candidate {
  std::size_t alignment = 0;  ///< index among the alignments
  std::size_t mode = 0;
  std::size_t modes = 1;  ///< that the alignment has
  BetweenFactor between;  ///< poses of i and j; covariance with the floor
  FramePair frames;
  /// +1 if moving the second frame of the pair (the later node of a loop) moves variable b, else -1.
  double sign = 1.0;

  /// A loop closure with several modes. Those of two lanes repeat alike, so that their wrong modes agree with
  /// each other as well as the right ones do: agreement is no evidence for them.
  bool is_ambiguous_loop() const { return frames.first == frames.second && modes > 1; }
};

/// Candidates between two frames that agree with each other, as far as GPS and odometry tell.
struct Hypothesis {
  FramePair frames;
  std::vector<std::size_t> members;  ///< candidates; at most one of each alignment
  /// What it costs GPS, odometry and the alignments taken so far to move one frame to where these say:
  /// squared Mahalanobis distance, three degrees of freedom.
  double shift = 0.0;
  double support = 0.0;   ///< log odds that the hypothesis is right, for the number of its members
  double evidence = 0.0;  ///< and less what the shift costs
};

/// Log odds that so many alignments that agree are right, rather than a repetition of the scene.
double support_of(double agreeing);

struct Evaluation {
  std::vector<Hypothesis> hypotheses;  ///< best evidence first
  std::vector<Hypothesis> rejected;    ///< whose members fit the estimate alone, but not together
};

/// The hypotheses among `candidates` (indices in `all`) of one frame pair, seen from a solved graph that none
/// of them contradicts. Of very many some are looked at, spread over the mission.
Evaluation evaluate(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                    const GraphSolver& solver, const Estimate& estimate);

/// By hypothesis of one frame pair: its members, and those of `candidates` that were not looked at and agree
/// with it better than with the others.
std::vector<std::vector<std::size_t>> agreeing(std::span<const Candidate> all,
                                               std::span<const Hypothesis> hypotheses,
                                               std::span<const std::size_t> candidates,
                                               const GraphSolver& solver, const Estimate& estimate);

/// How many of the alignments made just before and after a candidate, by the same frames, agree with it.
struct Vote {
  int agree = 0, disagree = 0;
};
/// Of each of `candidates` of one frame pair. Who would agree with anything is not counted.
std::vector<Vote> neighbours_votes(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                                   const GraphSolver& solver, const Estimate& estimate);

/// Which of the hypotheses around a loop that does not close may be the false one: without which GPS and
/// odometry fit the others best, or nearly so.
std::vector<Hypothesis> suspects_of(std::span<const Candidate> all, std::span<const Hypothesis> loop,
                                    const GraphSolver& solver, const Estimate& estimate);

}  // namespace fleetmap::graph
