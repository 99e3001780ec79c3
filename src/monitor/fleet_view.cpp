#include "fleetmap/monitor/fleet_view.hpp"

#include <set>
#include <tuple>

namespace fleetmap::monitor {

std::vector<AgentId> robots_of(const FleetView& view) {
  std::set<AgentId> robots(view.fleet.begin(), view.fleet.end());
  for (const graph::Node& node : view.nodes) robots.insert(node.id.agent);
  for (const graph::Alignment& alignment : view.alignments) robots.insert(alignment.computed_by);
  for (const Attempt& attempt : view.attempts)
    robots.insert({attempt.by, attempt.target.agent, attempt.source.agent});
  for (const Holding& holding : view.holdings) robots.insert({holding.holder, holding.maker});
  if (!view.self.empty()) robots.insert(view.self);
  return {robots.begin(), robots.end()};
}

Outcomes outcomes_of(const FleetView& view) {
  Outcomes outcomes;
  for (const graph::Alignment& used : view.placement.used)
    outcomes[{used.computed_by, used.seq}] = graph::AlignmentStatus::used;
  for (const graph::AlignmentOutcome& outcome : view.placement.outcomes)
    outcomes[{outcome.computed_by, outcome.seq}] = outcome.status;
  return outcomes;
}

std::vector<std::optional<std::size_t>> alignments_of_attempts(const FleetView& view) {
  // A pair that one robot registered again gives one alignment more: they are matched in order.
  std::map<std::tuple<AgentId, NodeId, NodeId>, std::vector<std::size_t>> of_pair;
  for (std::size_t k = view.alignments.size(); k-- > 0;) {
    const graph::Alignment& alignment = view.alignments[k];
    of_pair[{alignment.computed_by, alignment.i, alignment.j}].push_back(k);
  }
  std::vector<std::optional<std::size_t>> found(view.attempts.size());
  for (std::size_t k = 0; k < view.attempts.size(); ++k) {
    const Attempt& attempt = view.attempts[k];
    if (attempt.verdict != "accepted" && attempt.verdict != "ambiguous") continue;
    const auto left = of_pair.find({attempt.by, attempt.target, attempt.source});
    if (left == of_pair.end() || left->second.empty()) continue;
    found[k] = left->second.back();
    left->second.pop_back();
  }
  return found;
}

}  // namespace fleetmap::monitor
