#pragma once

#include <set>
#include <span>
#include <vector>

#include "rejection/linearised_candidate.hpp"
#include "rejection/prior_gating.hpp"

namespace fleetmap::graph {

/// Counts which of the two alignments before and the two after a candidate, along the track, are consistent
/// with it.
struct Votes {
  int consistent = 0, contradicting = 0;
};

/// Votes on each of `candidates` of one frame pair. An alignment votes for a candidate if any of its modes is
/// consistent with it, against it if none is, and abstains where it would be consistent with any position.
/// This test has no model in the literature: it uses that odometry between neighbours is precise to
/// centimetres, so it separates false alignments even where GPS makes any two candidates consistent.
std::vector<Votes> neighbour_votes(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                                   const SolvedGraph& solved);

/// Returns the candidates that at least two neighbours contradict, and more than are consistent with them.
/// If this rejects all compatible candidates of a frame pair, the votes decide nothing there and none is
/// returned.
std::set<std::size_t> rejected_by_neighbours(std::span<const Candidate> all, const PriorGating& gating,
                                             const SolvedGraph& prior);

}  // namespace fleetmap::graph
