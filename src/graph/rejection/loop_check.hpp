#pragma once

#include <span>
#include <vector>

#include "rejection/frame_joining.hpp"

namespace fleetmap::graph {

struct LoopCheck {
  TrialExclusions exclusions;
  JoinedFrames joined;
  bool repeated = false;  ///< frames were joined again, with exclusions
};

/// Searches for loops of hypotheses that do not close, for example a false one between two robots that both
/// met a third, and for chains of them that contradict GPS. In each loop it excludes the hypothesis without
/// which the others are closest to the prior, and joins the frames again, six times at most. If several
/// hypotheses may be the false one, all are undecided and join nothing. This is the consistency of cycles, as
/// in RRR (Latif et al., IJRR 2013), between hypotheses instead of single loop closures.
LoopCheck check_loops(const RejectionProblem& problem, const PriorEvidence& evidence,
                      const SolvedGraph& prior, JoinedFrames joined, GraphSolver& solver);

/// Returns the hypotheses around a loop that does not close which may be the false one: without each of them
/// the others are nearly as likely, given the prior, as without the best.
std::vector<Hypothesis> outlier_candidates(std::span<const Candidate> all, std::span<const Hypothesis> loop,
                                           const SolvedGraph& prior);

/// The shortest path of hypotheses that joins two frames without one between just these two. Empty if there
/// is none.
std::vector<Hypothesis> path_between(std::span<const Hypothesis> joining, const FramePair& frames,
                                     std::size_t frame_count);

}  // namespace fleetmap::graph
