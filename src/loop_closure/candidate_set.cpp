#include "candidate_set.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::loop_closure {

using Origin = LoopCandidate::Origin;

ScheduledCandidate* CandidateSet::find(const NodePair& pair) {
  for (Candidates* some : {&candidates_, &done_, &abandoned_}) {
    if (const auto found = some->find(pair); found != some->end()) return &found->second;
  }
  return nullptr;
}

const ScheduledCandidate& CandidateSet::held(const NodePair& pair) const {
  for (const Candidates* some : {&candidates_, &done_}) {
    if (const auto found = some->find(pair); found != some->end()) return found->second;
  }
  return abandoned_.at(pair);
}

void CandidateSet::conclude(const NodePair& pair) {
  Candidates& from = abandoned_.contains(pair) ? abandoned_ : candidates_;
  done_.insert(from.extract(pair)).position->second.phase = Phase::kDone;
}

bool CandidateSet::is_exhausted(const NodePair& pair, const ScheduledCandidate& candidate) const {
  return candidate.phase == Phase::kFailed &&
         (candidate.attempts >= config_.max_attempts || !too_near(pair, 1, true).empty());
}

void CandidateSet::set_known_to_peer(const NodeId& ours, const AgentId& peer) {
  for (Candidates* some : {&candidates_, &abandoned_}) {
    for (auto it = some->lower_bound({ours, {peer, 0}});
         it != some->end() && it->first.ours == ours && it->first.theirs.agent == peer; ++it)
      it->second.known_to_peer = true;
  }
}

void CandidateSet::reopen() {
  for (auto it = abandoned_.begin(); it != abandoned_.end();) {
    const auto current = it++;
    if (current->second.attempts < config_.max_attempts) candidates_.insert(abandoned_.extract(current));
  }
}

void CandidateSet::erase(const NodePair& pair) {
  candidates_.erase(pair);
  grid_.erase(pair);
  if (abandoned_.erase(pair) > 0) reopen();
}

ScheduledCandidate& CandidateSet::find_or_make(const NodePair& pair) {
  if (ScheduledCandidate* held = find(pair)) return *held;
  ScheduledCandidate& candidate = candidates_[pair];
  grid_.add(pair);
  candidate.candidate.target = pair.ours;
  candidate.candidate.source = pair.theirs;
  return candidate;
}

void CandidateSet::offer(const LoopCandidate& candidate, Stamp now) {
  const NodePair pair = candidate.pair();
  if (contains(pair)) return;
  const Stamp since = replace_rival(candidate, now);
  if (redundant(pair)) {
    ++redundant_;
    ++dropped_[pair.theirs.agent].redundant;
    return;
  }
  add(candidate, since, false);
}

void CandidateSet::add(const LoopCandidate& candidate, Stamp found, bool known_to_peer) {
  if (!nodes_.contains(candidate.pair())) return;  // its name became contested
  ScheduledCandidate scheduled;
  scheduled.candidate = candidate;
  scheduled.found = found;
  scheduled.next_match = found;
  scheduled.known_to_peer = known_to_peer;
  candidates_.emplace(candidate.pair(), scheduled);
  grid_.add(candidate.pair());
  crowd_out();
}

void CandidateSet::drop_redundant(const NodePair& pair) {
  ++dropped_[pair.theirs.agent].redundant;
  erase(pair);
  ++redundant_;
}

void CandidateSet::drop_uninformative(const NodePair& pair) {
  ++dropped_[pair.theirs.agent].uninformative;
  erase(pair);
}

std::map<AgentId, PeerCandidates> CandidateSet::by_peer() const {
  std::map<AgentId, PeerCandidates> peers = dropped_;
  for (const Candidates* some : {&candidates_, &done_, &abandoned_}) {
    for (const auto& [pair, candidate] : *some) {
      PeerCandidates& peer = peers[pair.theirs.agent];
      switch (candidate.phase) {
        case Phase::kWaiting:
          ++peer.waiting;
          break;
        case Phase::kRequested:
          ++peer.requested;
          break;
        case Phase::kRegistering:
          ++peer.registering;
          break;
        case Phase::kDone:
          ++peer.aligned;
          break;
        case Phase::kFailed:
          ++(candidate.registered ? peer.rejected : peer.not_received);
          peer.to_be_retried += some == &candidates_ && candidate.attempts < config_.max_attempts;
          break;
      }
    }
  }
  return peers;
}

Stamp CandidateSet::replace_rival(const LoopCandidate& candidate, Stamp now) {
  Stamp since = now;
  const bool by_descriptor = candidate.origin == Origin::kDescriptor;
  for (const NodePair& rival : rivals(candidate.pair())) {
    const ScheduledCandidate& other = candidates_.at(rival);
    if (other.phase != Phase::kWaiting) continue;
    const bool better = by_descriptor ? other.candidate.origin == Origin::kDescriptor &&
                                            other.candidate.match_score < candidate.match_score
                                      : other.candidate.distance > candidate.distance;
    if (!better) continue;
    // A nearer pair goes on waiting; the clouds of a better match begin to.
    if (!by_descriptor) since = std::min(since, other.found);
    drop_redundant(rival);
  }
  return since;
}

double CandidateSet::spacing(const ScheduledCandidate& other, const AgentId& peer) const {
  if (other.phase == Phase::kFailed) return config_.spacing_failed_m;
  return is_aligned(peer) ? std::max(config_.spacing_m, config_.spacing_aligned_m) : config_.spacing_m;
}

std::vector<NodePair> CandidateSet::too_near(const NodePair& pair, std::size_t max, bool closed_only) const {
  std::vector<NodePair> found;
  if (!nodes_.contains(pair)) return found;
  for (const NodePair& other : grid_.around(pair.ours)) {
    if (found.size() >= max) break;
    if (other == pair || other.theirs.agent != pair.theirs.agent) continue;
    if (closed_only && candidates_.contains(other)) continue;
    const double limit = spacing(held(other), pair.theirs.agent);
    if (nodes_.near(pair.ours, other.ours, limit) && nodes_.near(pair.theirs, other.theirs, limit))
      found.push_back(other);
  }
  return found;
}

std::vector<NodePair> CandidateSet::rivals(const NodePair& pair) const {
  const std::vector<NodePair> nearby = too_near(pair, 2);
  if (nearby.size() != 1) return {};
  const ScheduledCandidate& only = held(nearby.front());
  const bool under_way = only.phase == Phase::kWaiting || only.phase == Phase::kRequested;
  return under_way && !only.known_to_peer ? nearby : std::vector<NodePair>{};
}

bool CandidateSet::retryable(const NodePair& pair, const ScheduledCandidate& candidate) const {
  return candidate.phase == Phase::kFailed && candidate.attempts < config_.max_attempts && !redundant(pair);
}

std::size_t CandidateSet::waiting() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      candidates_, [](const auto& entry) { return entry.second.phase == Phase::kWaiting; }));
}

std::size_t CandidateSet::room() const {
  return config_.max_waiting - std::min(config_.max_waiting, waiting());
}

void CandidateSet::crowd_out() {
  if (waiting() <= config_.max_waiting) return;
  const auto waiting_by_age = [](const auto& entry) {
    return std::pair(entry.second.phase != Phase::kWaiting, entry.second.found);
  };
  const NodePair oldest = std::ranges::min_element(candidates_, {}, waiting_by_age)->first;
  ++dropped_[oldest.theirs.agent].overflowed;
  erase(oldest);
  ++crowded_out_;
}

}  // namespace fleetmap::loop_closure
