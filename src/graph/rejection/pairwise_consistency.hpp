#pragma once

#include <optional>
#include <set>
#include <span>
#include <vector>

#include "rejection/hypothesis.hpp"

namespace fleetmap::graph {

/// Hypotheses of one frame pair.
struct ConsistentSets {
  std::vector<Hypothesis> hypotheses;  ///< best evidence first
  std::vector<Hypothesis> rejected;    ///< too far from the prior, though each member alone may be compatible
};

/// Partitions `candidates` of one frame pair into pairwise consistent sets: pairwise consistency
/// maximisation (Mangelson et al., ICRA 2018) with greedy cliques. Two candidates are tested against the
/// whole solved graph with all correlations, and a set has at most one mode of an alignment. More than 16
/// candidates are represented by 16 of them, evenly spaced. The solved graph must not contain any of the
/// candidates.
ConsistentSets consistent_sets(std::span<const Candidate> all, std::span<const std::size_t> candidates,
                               const SolvedGraph& solved);

/// The hypothesis of most evidence without members in `excluded`, if its log odds are positive and kMargin
/// ahead of the next one's.
std::optional<Hypothesis> clear_best(const ConsistentSets& sets, const std::set<std::size_t>& excluded);

/// Members of each hypothesis of one frame pair, and those of `candidates` in no hypothesis that are
/// consistent with it and more likely under it than under the others.
std::vector<Indices> extended_members(std::span<const Candidate> all, std::span<const Hypothesis> hypotheses,
                                      std::span<const std::size_t> candidates, const SolvedGraph& solved);

}  // namespace fleetmap::graph
