#include "rejection/alignment_statuses.hpp"

namespace fleetmap::graph {
namespace {

struct ModeCounts {
  std::size_t all = 0;
  std::size_t against_prior = 0;
  std::size_t against_any = 0;  ///< at the end: gated out, contradicting or excluded
  bool undecided = false;       ///< one of them is part of an undecided loop
};

AlignmentStatus status_of(const ModeCounts& modes) {
  if (modes.against_prior == modes.all) return AlignmentStatus::against_gps;
  if (!modes.undecided && modes.against_any == modes.all) return AlignmentStatus::against_others;
  return AlignmentStatus::undecided;
}

}  // namespace

std::map<std::size_t, AlignmentStatus> rejected_statuses(std::span<const Candidate> candidates,
                                                         const PriorEvidence& evidence,
                                                         const LoopCheck& check) {
  std::map<std::size_t, ModeCounts> counts;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (check.joined.accepted.contains(candidates[c].alignment)) continue;
    ModeCounts& modes = counts[candidates[c].alignment];
    ++modes.all;
    modes.against_prior += evidence.contradicting.contains(c);
    modes.against_any += check.joined.contradicting.contains(c) || evidence.gating.gated_out.contains(c) ||
                         check.exclusions.candidates.contains(c);
    modes.undecided = modes.undecided || check.exclusions.undecided.contains(c);
  }
  std::map<std::size_t, AlignmentStatus> statuses;
  for (const auto& [alignment, modes] : counts) statuses.emplace(alignment, status_of(modes));
  return statuses;
}

}  // namespace fleetmap::graph
