#pragma once

#include <span>
#include <vector>

#include "rejection/candidate.hpp"

namespace fleetmap::graph::bench {

/// Outcome of a method of outlier rejection.
struct Outcome {
  std::vector<bool> kept;  ///< by candidate
  Estimate estimate;
};

/// Quantile of chi squared, six degrees of freedom, 1e-4: the threshold of all methods here, and of our
/// pairwise test.
inline constexpr double kGate = 27.9;

/// Pairwise consistency maximisation (Mangelson et al., ICRA 2018): of each pair of frames the largest set of
/// alignments that are consistent with each other by odometry, found by the clique heuristic of Pattabiraman
/// et al. (2015), then least squares with these.
Outcome pcm(const ReducedGraph& graph, std::span<const Candidate> candidates, const Estimate& initial);

/// Graduated non-convexity with truncated least squares (Yang et al., RA-L 2020), on those in `among`.
Outcome gnc(const ReducedGraph& graph, std::span<const Candidate> candidates, const Estimate& initial,
            const std::vector<bool>& among);

/// Cauchy kernel by iteratively reweighted least squares. Kept are those within the gate at the end.
Outcome cauchy(const ReducedGraph& graph, std::span<const Candidate> candidates, const Estimate& initial);

/// Least squares with the given candidates.
Outcome least_squares(const ReducedGraph& graph, std::span<const Candidate> candidates,
                      const Estimate& initial, const std::vector<bool>& kept);

}  // namespace fleetmap::graph::bench
