#pragma once

#include <span>
#include <vector>

#include "rejection/linearised_candidate.hpp"

namespace fleetmap::graph {

/// A hypothesis is preferred to another one only if its log odds exceed the other's by this.
inline constexpr double kMargin = 3.0;

/// Pairwise consistent candidates between two frames.
struct Hypothesis {
  FramePair frames;
  Indices members;  ///< at most one of each alignment
  /// d^2: squared Mahalanobis distance to the prior, by which one frame must move for all members to fit;
  /// three degrees of freedom. The prior is the solved graph.
  double distance = 0.0;
  double support = 0.0;   ///< log odds that it is right, by the number of its members
  double evidence = 0.0;  ///< log odds with the prior: support - distance / 2
};

/// Log odds 6 log2(1 + n) that n consistent alignments are right and not a repetition of the scene. Not
/// linear in n, because registrations of one place fail together.
double support_of(double members);

/// Squared Mahalanobis distance to the prior of several hypotheses together: each frame pair is translated as
/// a whole, three degrees of freedom a pair, such that all members fit best. `hypotheses` are indices in
/// `candidates`.
double squared_distance_to_prior(const std::vector<Indices>& hypotheses,
                                 std::span<const LinearisedCandidate> candidates,
                                 const CrossCovariances& cross);

/// Members of one hypothesis that enter its distance, so that its cost is bounded.
inline constexpr std::size_t kMaxJointCandidates = 12;

}  // namespace fleetmap::graph
