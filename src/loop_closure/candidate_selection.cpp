#include "candidate_selection.hpp"

#include <tuple>
#include <utility>

namespace fleetmap::loop_closure {
namespace {

using Phase = ScheduledCandidate::Phase;

}  // namespace

bool CandidateSelection::clouds_complete(const NodePair& pair, const ScheduledCandidate& candidate,
                                         Stamp now) const {
  if (candidate.phase == Phase::kFailed) return now >= candidate.retry_at;
  if (now >= candidate.found + config_.max_wait) return true;
  return nodes_.nodes_after(pair.ours) >= config_.min_nodes_after &&
         nodes_.nodes_after(pair.theirs) >= config_.min_nodes_after;
}

std::vector<NodePair> CandidateSelection::ready(const std::function<bool(const AgentId&)>& is_heard,
                                                Stamp now) {
  std::vector<NodePair> ready, obsolete, exhausted;
  for (const auto& [pair, candidate] : candidates_.open()) {
    // The cheap conditions are tested first: the others search around the pair.
    if (!is_heard(pair.theirs.agent) || !clouds_complete(pair, candidate, now)) continue;
    if (candidate.phase != Phase::kWaiting && !candidates_.retryable(pair, candidate)) {
      if (candidates_.is_exhausted(pair, candidate)) exhausted.push_back(pair);
      continue;
    }
    // The spacing grows with the first good alignment.
    const bool is_obsolete =
        candidate.phase == Phase::kWaiting && !candidate.known_to_peer && candidates_.redundant(pair);
    (is_obsolete ? obsolete : ready).push_back(pair);
  }
  for (const NodePair& pair : exhausted) candidates_.abandon(pair);
  for (const NodePair& pair : obsolete) {
    // Two candidates may make each other redundant: the second one stays.
    if (candidates_.redundant(pair)) {
      candidates_.drop_redundant(pair);
    } else {
      ready.push_back(pair);
    }
  }
  return ready;
}

std::optional<CandidateSelection::Selected> CandidateSelection::next(std::vector<NodePair>& ready,
                                                                     bool radio_has_room) {
  std::vector<graph::InformationGain::Pair> pairs, expected;
  for (const NodePair& pair : ready) pairs.emplace_back(pair.ours, pair.theirs);
  for (const auto& [pair, candidate] : candidates_.open()) {
    if (candidate.under_way()) expected.emplace_back(pair.ours, pair.theirs);
  }
  const std::vector<double> information = information_.of(pairs, expected);
  std::optional<std::size_t> best;
  std::vector<NodePair> left;
  const auto before = [&](std::size_t a, std::size_t b) {
    const Stamp found_a = candidates_.at(ready[a]).found, found_b = candidates_.at(ready[b]).found;
    if (config_.order == exchange::CloudOrder::kFirstCome) return found_a < found_b;
    return std::tuple(information[a], found_a) > std::tuple(information[b], found_b);
  };
  for (std::size_t k = 0; k < ready.size(); ++k) {
    if (information[k] < config_.min_information && !radio_has_room) {
      candidates_.drop_uninformative(ready[k]);
      ++uninformative_;
    } else if (!best || before(k, *best)) {
      if (best) left.push_back(ready[*best]);
      best = k;
    } else {
      left.push_back(ready[k]);
    }
  }
  std::optional<Selected> selected;
  if (best) selected = Selected{ready[*best], information[*best]};
  ready = std::move(left);
  return selected;
}

}  // namespace fleetmap::loop_closure
