#pragma once

#include <map>
#include <set>

#include "rejection/prior_evidence.hpp"

namespace fleetmap::graph {

/// Candidates and frames that a loop check excludes from the next trial.
struct TrialExclusions {
  std::set<std::size_t> candidates;  ///< of hypotheses that are inconsistent around a loop
  std::set<std::size_t> undecided;   ///< of these, where several hypotheses may be the false one
  std::set<FramePair> frames;        ///< with undecided hypotheses: they join nothing
};

/// The accepted candidates and the graph solved with them.
struct JoinedFrames {
  bool solved = false;
  Estimate estimate;
  std::map<std::size_t, std::size_t> accepted{};  ///< alignment to candidate
  std::set<std::size_t> contradicting{};          ///< candidates that the accepted ones contradict
};

/// Factors of the accepted candidates, in the order of the alignments.
std::vector<const BetweenFactor*> factors_of(std::span<const Candidate> candidates,
                                             const std::map<std::size_t, std::size_t>& accepted);
/// Pose variables at the ends of the candidates.
std::vector<int> ends_of(std::span<const Candidate> candidates);

/// Accepts hypotheses in order of evidence: the clear best one of each pair of unconnected frames joins them;
/// the graph is solved; all candidates are gated anew with its smaller covariance; single candidates are
/// accepted where it is certain; accepted ones that the rest contradicts are removed. Four rounds at most.
/// Like graduated non-convexity (Yang et al., RA-L 2020) it goes from certain to less certain candidates, but
/// with decisions instead of weights.
///
/// `prior` is the solution without alignments. `solver` was made for all pairs that are not gated out and is
/// left with the accepted factors.
JoinedFrames join_frames(const RejectionProblem& problem, const PriorEvidence& evidence,
                         const TrialExclusions& exclusions, const Estimate& prior, GraphSolver& solver);

}  // namespace fleetmap::graph
