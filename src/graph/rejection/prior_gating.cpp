#include "rejection/prior_gating.hpp"

#include "rejection/innovation.hpp"

namespace fleetmap::graph {
namespace {

/// Candidates up to this many times the gate may be right where GPS is wrong, so other alignments decide.
constexpr double kGatedOut = 4.0;

}  // namespace

PriorGating gate_by_prior(std::span<const Candidate> candidates, const SolvedGraph& prior) {
  PriorGating gating;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    Indices& group = gating.groups[candidates[c].frames];
    Indices& compatible = gating.compatible[candidates[c].frames];
    const double distance = innovation(candidates[c].factor, prior).distance;
    if (distance < kInnovationGate) {
      compatible.push_back(c);
    } else {
      gating.contradicting.insert(c);
    }
    if (distance < kGatedOut * kInnovationGate) {
      group.push_back(c);
    } else {
      gating.gated_out.insert(c);
    }
  }
  return gating;
}

}  // namespace fleetmap::graph
