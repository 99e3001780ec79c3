#include "fleetmap/loop_closure/candidate_scheduler.hpp"

#include <algorithm>
#include <utility>

#include "candidate_selection.hpp"
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

void fail(ScheduledCandidate& candidate, Stamp retry_at) {
  candidate.phase = Phase::kFailed;
  candidate.retry_at = retry_at;
}

}  // namespace

struct CandidateScheduler::State {
  State(const AgentId& self, const CandidateConfig& config)
      : nodes(self, config.max_sigma_m),
        positions(self, config.proximity),
        descriptors(config.descriptors, config.proximity.max_radius),
        transforms(self, config.proximity, nodes),
        candidates(config, nodes),
        selection(config, nodes, candidates) {}

  NodeIndex nodes;
  PositionCandidates positions;
  DescriptorCandidates descriptors;
  TransformCandidates transforms;
  CandidateSet candidates;
  CandidateSelection selection;
};

CandidateScheduler::CandidateScheduler(const AgentId& self, const CandidateConfig& config)
    : self_(self), config_(config), state_(std::make_unique<State>(self, config_)) {}

CandidateScheduler::~CandidateScheduler() = default;

// ---- candidates
// -------------------------------------------------------------------------------------------------

void CandidateScheduler::on_node(const graph::Node& node, Stamp now) {
  State& state = *state_;
  if (!state.nodes.add(node)) return;
  state.candidates.on_node(node.id);
  state_->selection.information().add(node);
  for (const LoopCandidate& candidate : state.transforms.propose(node)) offer_by_transform(candidate, now);
  const bool located = state.nodes.located(node);
  const auto side =
      node.id.agent == self_ ? DescriptorCandidates::Side::kOurs : DescriptorCandidates::Side::kTheirs;
  for (const LoopCandidate& candidate : state.descriptors.propose(node, located, side)) {
    ++stats_.by_descriptor;
    // A transform is more accurate than a match, and may show that the two are far apart.
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
    if (candidate.phase == Phase::kRegistering) return false;  // its result is still to be recorded
    if (candidate.phase == Phase::kRequested) withdrawn_.push_back(pair);
    return true;
  });
  state_->candidates.on_removed_node();
}

void CandidateScheduler::on_used_alignments(std::span<const graph::Alignment> used) {
  state_->selection.information().use(used);
  const NodeIndex& nodes = state_->nodes;
  std::uint64_t obsolete = 0;
  for (const auto& frames : state_->transforms.on_used_alignments(used)) {
    // Waiting candidates are found again if they are near; a failed descriptor match had another prior.
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
  // Without both nodes the pair cannot be compared; the missing node will make the candidate.
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
  state_->candidates.set_known_to_peer(ours, peer);
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
  if (good) state_->selection.information().add(alignment);
  const bool first_is_ours = alignment.i.agent == self_;
  if (first_is_ours == (alignment.j.agent == self_)) return;  // between others, or within our own track
  const NodePair pair =
      first_is_ours ? NodePair{alignment.i, alignment.j} : NodePair{alignment.j, alignment.i};
  // An ambiguous alignment ends the candidate, since the same clouds would be ambiguous again, but it does
  // not determine the relative pose.
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
  state_->candidates.conclude(pair);
}

void CandidateScheduler::on_cloud(const NodeId& theirs, Bytes cloud) {
  state_->candidates.for_each([&](const NodePair& pair, ScheduledCandidate& candidate) {
    if (pair.theirs != theirs || candidate.phase != Phase::kRequested) return;
    candidate.phase = Phase::kRegistering;
    candidate.registered = true;
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

void CandidateScheduler::request(exchange::CloudDemand& demand, Stamp now, bool radio_has_room) {
  CandidateSet& candidates = state_->candidates;
  // A robot that fell silent must not keep the others waiting for its clouds.
  auto active = static_cast<std::size_t>(std::ranges::count_if(candidates.open(), [&](const auto& entry) {
    const auto& [pair, candidate] = entry;
    return (candidate.phase == Phase::kRequested && heard(pair.theirs.agent, now)) ||
           candidate.phase == Phase::kRegistering;
  }));
  if (active >= config_.max_active) return;
  CandidateSelection& selection = state_->selection;
  const auto is_heard = [&](const AgentId& peer) { return heard(peer, now); };
  for (std::vector<NodePair> ready = selection.ready(is_heard, now);
       !ready.empty() && active < config_.max_active;) {
    const auto next = selection.next(ready, radio_has_room);
    if (!next) return;
    ScheduledCandidate& selected = candidates.at(next->pair);
    selected.phase = Phase::kRequested;
    ++selected.attempts;
    ++stats_.requested;
    ++active;
    demand.wanted.push_back({next->pair.theirs, next->information});
    // The place that was selected may make others redundant.
    std::erase_if(ready, [&](const NodePair& pair) {
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
  return std::ranges::any_of(state_->candidates.open(), [&](const auto& entry) {
    return entry.first.theirs == theirs && entry.second.phase == Phase::kRequested;
  });
}

bool CandidateScheduler::idle(Stamp now, const std::set<AgentId>& without) const {
  const CandidateSet& candidates = state_->candidates;
  if (state_->transforms.pending() && candidates.room() > 0) return false;
  return std::ranges::none_of(candidates.open(), [&](const auto& entry) {
    const auto& [pair, candidate] = entry;
    if (without.contains(pair.theirs.agent)) return false;
    if (candidate.under_way()) return true;
    if (!heard(pair.theirs.agent, now)) return false;
    return candidate.phase == Phase::kWaiting || candidates.retryable(pair, candidate);
  });
}

bool CandidateScheduler::has_good_alignment(const AgentId& peer) const {
  return state_->candidates.is_aligned(peer);
}

CandidateStats CandidateScheduler::stats() const {
  CandidateStats all = stats_;
  all.redundant = state_->candidates.redundant_count();
  all.overflowed = state_->candidates.overflowed_count();
  all.uninformative = state_->selection.uninformative_count();
  return all;
}

std::map<AgentId, PeerCandidates> CandidateScheduler::by_peer(Stamp now) const {
  std::map<AgentId, PeerCandidates> peers = state_->candidates.by_peer();
  for (auto& [peer, candidates] : peers) candidates.heard = heard(peer, now);
  return peers;
}

}  // namespace fleetmap::loop_closure
