#include "fleetmap/loop_closure/candidate_scheduler.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "candidate_set.hpp"
#include "descriptor_candidates.hpp"
#include "node_index.hpp"
#include "position_candidates.hpp"
#include "transform_candidates.hpp"

namespace fleetmap::loop_closure {
namespace {

using Phase = ScheduledCandidate::Phase;
using Origin = LoopCandidate::Origin;

/// A search visits all nodes of a robot, and thousands are due once two long tracks have a transform.
constexpr std::size_t kMaxSearchesPerTick = 20;

bool under_way(const ScheduledCandidate& candidate) {
  return candidate.phase == Phase::kRequested || candidate.phase == Phase::kRegistering;
}

void fail(ScheduledCandidate& candidate, Stamp retry_at) {
  candidate.phase = Phase::kFailed;
  candidate.retry_at = retry_at;
}

}  // namespace

struct CandidateScheduler::State {
  State(const AgentId& self, const LoopClosureConfig& config)
      : nodes(self, config.max_sigma_m),
        positions(self, config.proximity),
        descriptors(config.descriptors, config.proximity.max_radius),
        transforms(self, config.proximity, nodes),
        candidates(config, nodes) {}

  NodeIndex nodes;
  PositionCandidates positions;
  DescriptorCandidates descriptors;
  TransformCandidates transforms;
  CandidateSet candidates;
};

CandidateScheduler::CandidateScheduler(const AgentId& self, const LoopClosureConfig& config)
    : self_(self), config_(config), state_(std::make_unique<State>(self, config_)) {}

CandidateScheduler::~CandidateScheduler() = default;

// ---- candidates
// -------------------------------------------------------------------------------------------------

void CandidateScheduler::on_node(const graph::Node& node, Stamp now) {
  State& state = *state_;
  if (!state.nodes.add(node)) return;
  information_.add(node);
  for (const LoopCandidate& candidate : state.transforms.propose(node)) offer_by_transform(candidate, now);
  const bool located = state.nodes.located(node);
  const auto side =
      node.id.agent == self_ ? DescriptorCandidates::Side::kOurs : DescriptorCandidates::Side::kTheirs;
  for (const LoopCandidate& candidate : state.descriptors.propose(node, located, side)) {
    ++stats_.by_descriptor;
    // A transform tells more than a match, and may tell that the two are far apart.
    if (!transform(candidate.pair())) state.candidates.offer(candidate, now);
  }
  if (!located) return;
  for (const LoopCandidate& candidate : state.positions.propose(node)) {
    ++stats_.by_position;
    state.candidates.offer(candidate, now);
  }
}

void CandidateScheduler::offer_by_transform(const LoopCandidate& candidate, Stamp now) {
  ++stats_.by_transform;
  state_->candidates.offer(candidate, now);
  if (auto* known = state_->candidates.find(candidate.pair())) known->by_transform = true;
}

void CandidateScheduler::on_contested(const NodeId& node) {
  state_->nodes.remove(node);
  state_->transforms.remove(node);
  state_->candidates.erase_if([&](const NodePair& pair, const ScheduledCandidate& candidate) {
    if (pair.ours != node && pair.theirs != node) return false;
    if (candidate.phase == Phase::kRegistering) return false;  // its result comes anyway
    if (candidate.phase == Phase::kRequested) withdrawn_.push_back(pair);
    return true;
  });
}

void CandidateScheduler::on_used_alignments(std::span<const graph::Alignment> used) {
  information_.use(used);
  const NodeIndex& nodes = state_->nodes;
  std::uint64_t obsolete = 0;
  for (const auto& frames : state_->transforms.on_used_alignments(used)) {
    // What waits is found again, if it is near; a descriptor match that failed had another prior.
    state_->candidates.erase_if([&](const NodePair& pair, const ScheduledCandidate& candidate) {
      if (candidate.known_to_peer || !nodes.lacks_position(pair)) return false;
      if (nodes.find(pair.ours)->frame != frames.first || nodes.find(pair.theirs)->frame != frames.second)
        return false;
      const bool by_descriptor = candidate.candidate.origin == Origin::kDescriptor;
      const bool again = (candidate.phase == Phase::kWaiting && (by_descriptor || candidate.by_transform)) ||
                         (candidate.phase == Phase::kFailed && by_descriptor && !candidate.by_transform);
      obsolete += again;
      return again;
    });
  }
  state_->candidates.count_redundant(obsolete);
}

std::optional<UncertainPose> CandidateScheduler::transform(const NodePair& pair) const {
  return state_->transforms.transform(pair);
}

// ---- the match handshake
// ----------------------------------------------------------------------------------------

void CandidateScheduler::on_match(const messages::ProximityMatch& match, Stamp now) {
  const NodePair pair{match.theirs, match.ours};  // the sender's "ours" is our "theirs"
  if (match.to != self_ || pair.ours.agent != self_ || pair.theirs.agent != match.from) return;
  CandidateSet& candidates = state_->candidates;
  if (auto* known = candidates.find(pair)) {
    known->known_to_peer = true;
    return;
  }
  // Without both nodes there is nothing to compare; when the missing one comes, it makes the candidate.
  if (!state_->nodes.contains(pair) || !(match.distance <= config_.proximity.max_radius)) return;
  ++stats_.by_position;
  if (candidates.redundant(pair)) yield_to(pair);
  if (candidates.redundant(pair)) return candidates.count_redundant();
  candidates.add({pair.ours, pair.theirs, Origin::kPeer, match.distance, match.radius}, now, true);
}

void CandidateScheduler::yield_to(const NodePair& pair) {
  // Both ends compare the two pairs in the same order, so both keep the same one.
  const auto order = [](const NodePair& p) { return std::minmax(p.ours, p.theirs); };
  for (const NodePair& rival : state_->candidates.rivals(pair)) {
    if (order(rival) < order(pair)) continue;
    stats_.yielded += state_->candidates.at(rival).phase == Phase::kRequested;
    withdrawn_.push_back(rival);
    state_->candidates.erase(rival);
  }
}

void CandidateScheduler::on_cloud_request(const AgentId& peer, const NodeId& ours) {
  state_->candidates.for_each([&](const NodePair& pair, ScheduledCandidate& candidate) {
    if (pair.ours == ours && pair.theirs.agent == peer) candidate.known_to_peer = true;
  });
}

void CandidateScheduler::announce(exchange::CloudDemand& demand, Stamp now) {
  state_->candidates.for_each([&](const NodePair& pair, ScheduledCandidate& candidate) {
    if (candidate.phase != Phase::kRequested || candidate.known_to_peer) return;
    if (candidate.matches_sent >= config_.match_repeats || now < candidate.next_match) return;
    ++candidate.matches_sent;
    candidate.next_match = now + config_.match_period;
    demand.matches.push_back({self_, pair.theirs.agent, pair.theirs, pair.ours, candidate.candidate.distance,
                              candidate.candidate.radius});
  });
}

bool CandidateScheduler::heard(const AgentId& peer, Stamp now) const {
  const auto last = heard_.find(peer);
  return last != heard_.end() && now - last->second <= config_.peer_timeout;
}

// ---- results
// ----------------------------------------------------------------------------------------------------

void CandidateScheduler::on_alignment(const graph::Alignment& alignment, Stamp) {
  const bool good = alignment.best().rmse <= graph::kGoodRmse;
  if (good) information_.add(alignment);
  const bool first_is_ours = alignment.i.agent == self_;
  if (first_is_ours == (alignment.j.agent == self_)) return;  // between others, or within our own track
  const NodePair pair =
      first_is_ours ? NodePair{alignment.i, alignment.j} : NodePair{alignment.j, alignment.i};
  // An ambiguous one ends the candidate, since the same clouds would be ambiguous again, but it does not give
  // the relative pose yet.
  if (good && !alignment.ambiguous()) state_->candidates.on_aligned(pair.theirs.agent);
  const bool by_us = alignment.computed_by == self_;
  if (!by_us && !(good && config_.stop_when_peer_aligned)) return;
  if (by_us && !alignment.ambiguous()) state_->transforms.on_accepted(pair.theirs.agent);
  // There is none of one from before a restart, or that the peer alone had.
  ScheduledCandidate& candidate = state_->candidates.find_or_make(pair);
  if (candidate.phase == Phase::kDone) return;
  if (by_us) {
    ++stats_.accepted;
  } else if (candidate.phase == Phase::kRegistering) {
    return;  // the bytes are spent: our own result is welcome as well
  } else if (candidate.phase == Phase::kRequested) {
    ++stats_.ended_by_peer;
    withdrawn_.push_back(pair);
  }
  candidate.phase = Phase::kDone;
}

void CandidateScheduler::on_cloud(const NodeId& theirs, Bytes cloud) {
  state_->candidates.for_each([&](const NodePair& pair, ScheduledCandidate& candidate) {
    if (pair.theirs != theirs || candidate.phase != Phase::kRequested) return;
    candidate.phase = Phase::kRegistering;
    candidate.candidate.T_target_source = transform(pair);
    candidate.by_transform = candidate.candidate.T_target_source.has_value();
    received_.push_back({candidate.candidate, cloud});
  });
}

std::vector<ReceivedCloud> CandidateScheduler::take_received() { return std::exchange(received_, {}); }

void CandidateScheduler::on_cloud_lost(const NodeId& theirs, Stamp now) {
  state_->candidates.for_each([&](const NodePair& pair, ScheduledCandidate& candidate) {
    if (pair.theirs != theirs || candidate.phase != Phase::kRequested) return;
    ++stats_.lost;
    fail(candidate, now + config_.retry_after);
  });
}

void CandidateScheduler::on_rejected(const NodePair& pair, Stamp now) {
  ScheduledCandidate* candidate = state_->candidates.find(pair);
  if (candidate == nullptr || candidate->phase != Phase::kRegistering) return;
  ++stats_.rejected;
  fail(*candidate, now + config_.retry_after);
  const AgentId& peer = pair.theirs.agent;
  if (!candidate->by_transform || !state_->transforms.on_rejected(peer)) return;
  state_->candidates.erase_if([&](const NodePair& other, const ScheduledCandidate& waiting) {
    return waiting.phase == Phase::kWaiting && waiting.by_transform && other.theirs.agent == peer;
  });
}

// ---- requests
// ---------------------------------------------------------------------------------------------------

bool CandidateScheduler::retryable(const NodePair& pair, const ScheduledCandidate& candidate) const {
  return candidate.phase == Phase::kFailed && candidate.attempts < config_.max_attempts &&
         !state_->candidates.redundant(pair);
}

std::vector<NodePair> CandidateScheduler::ready(Stamp now) {
  CandidateSet& candidates = state_->candidates;
  const auto clouds_complete = [&](const NodePair& pair, const ScheduledCandidate& candidate) {
    if (candidate.phase == Phase::kFailed) return now >= candidate.retry_at;
    if (now >= candidate.found + config_.max_wait) return true;
    return state_->nodes.nodes_after(pair.ours) >= config_.min_nodes_after &&
           state_->nodes.nodes_after(pair.theirs) >= config_.min_nodes_after;
  };
  std::vector<NodePair> ready, obsolete;
  for (const auto& [pair, candidate] : candidates.all()) {
    // The cheap conditions come first: redundant() visits all others.
    if (!heard(pair.theirs.agent, now) || !clouds_complete(pair, candidate)) continue;
    if (candidate.phase != Phase::kWaiting && !retryable(pair, candidate)) continue;
    // The spacing grows with the first good alignment.
    const bool is_obsolete =
        candidate.phase == Phase::kWaiting && !candidate.known_to_peer && candidates.redundant(pair);
    (is_obsolete ? obsolete : ready).push_back(pair);
  }
  for (const NodePair& pair : obsolete) {
    // Of two that make each other redundant one stays.
    if (candidates.redundant(pair)) {
      candidates.drop_redundant(pair);
    } else {
      ready.push_back(pair);
    }
  }
  return ready;
}

std::optional<CandidateScheduler::Choice> CandidateScheduler::choose(std::vector<NodePair>& ready,
                                                                     bool radio_has_room) {
  CandidateSet& candidates = state_->candidates;
  std::vector<graph::AlignmentWorth::Pair> pairs, expected;
  for (const NodePair& pair : ready) pairs.emplace_back(pair.ours, pair.theirs);
  for (const auto& [pair, candidate] : candidates.all()) {
    if (under_way(candidate)) expected.emplace_back(pair.ours, pair.theirs);
  }
  const std::vector<double> information = information_.of(pairs, expected);
  std::optional<std::size_t> best;
  std::vector<NodePair> left;
  const auto before = [&](std::size_t a, std::size_t b) {
    const Stamp found_a = candidates.at(ready[a]).found, found_b = candidates.at(ready[b]).found;
    if (config_.order == exchange::CloudOrder::kFirstCome) return found_a < found_b;
    return std::tuple(information[a], found_a) > std::tuple(information[b], found_b);
  };
  for (std::size_t k = 0; k < ready.size(); ++k) {
    if (information[k] < config_.min_information && !radio_has_room) {
      candidates.erase(ready[k]);
      ++stats_.uninformative;
    } else if (!best || before(k, *best)) {
      if (best) left.push_back(ready[*best]);
      best = k;
    } else {
      left.push_back(ready[k]);
    }
  }
  std::optional<Choice> choice;
  if (best) choice = Choice{ready[*best], information[*best]};
  ready = std::move(left);
  return choice;
}

void CandidateScheduler::request(exchange::CloudDemand& demand, Stamp now, bool radio_has_room) {
  CandidateSet& candidates = state_->candidates;
  // A robot that fell silent must not keep the others waiting for its clouds.
  auto active = static_cast<std::size_t>(std::ranges::count_if(candidates.all(), [&](const auto& entry) {
    const auto& [pair, candidate] = entry;
    return (candidate.phase == Phase::kRequested && heard(pair.theirs.agent, now)) ||
           candidate.phase == Phase::kRegistering;
  }));
  if (active >= config_.max_active) return;
  for (std::vector<NodePair> waiting = ready(now); !waiting.empty() && active < config_.max_active;) {
    const auto choice = choose(waiting, radio_has_room);
    if (!choice) return;
    ScheduledCandidate& chosen = candidates.at(choice->pair);
    chosen.phase = Phase::kRequested;
    ++chosen.attempts;
    ++stats_.requested;
    ++active;
    demand.wanted.push_back({choice->pair.theirs, choice->information});
    // The place that was chosen may make others redundant.
    std::erase_if(waiting, [&](const NodePair& pair) {
      const ScheduledCandidate& other = candidates.at(pair);
      if (other.phase != Phase::kWaiting || other.known_to_peer || !candidates.redundant(pair)) return false;
      candidates.drop_redundant(pair);
      return true;
    });
  }
}

exchange::CloudDemand CandidateScheduler::tick(Stamp now, bool radio_has_room) {
  exchange::CloudDemand demand;
  if (state_->transforms.pending()) {
    const std::size_t searches = std::min(kMaxSearchesPerTick, state_->candidates.room());
    for (const LoopCandidate& candidate : state_->transforms.propose_pending(searches))
      offer_by_transform(candidate, now);
  }
  request(demand, now, radio_has_room);
  announce(demand, now);
  std::swap(demand.withdrawn, withdrawn_);
  return demand;
}

// ---- state
// ------------------------------------------------------------------------------------------------------

bool CandidateScheduler::wants(const NodeId& theirs) const {
  return std::ranges::any_of(state_->candidates.all(), [&](const auto& entry) {
    return entry.first.theirs == theirs && entry.second.phase == Phase::kRequested;
  });
}

bool CandidateScheduler::idle(Stamp now, const std::set<AgentId>& without) const {
  const CandidateSet& candidates = state_->candidates;
  if (state_->transforms.pending() && candidates.room() > 0) return false;
  return std::ranges::none_of(candidates.all(), [&](const auto& entry) {
    const auto& [pair, candidate] = entry;
    if (without.contains(pair.theirs.agent)) return false;
    if (under_way(candidate)) return true;
    if (!heard(pair.theirs.agent, now)) return false;
    return candidate.phase == Phase::kWaiting || retryable(pair, candidate);
  });
}

bool CandidateScheduler::has_good_alignment(const AgentId& peer) const {
  return state_->candidates.is_aligned(peer);
}

LoopClosureStats CandidateScheduler::stats() const {
  LoopClosureStats all = stats_;
  all.redundant = state_->candidates.redundant_count();
  all.crowded_out = state_->candidates.crowded_out_count();
  return all;
}

}  // namespace fleetmap::loop_closure
