#include "fleetmap/exchange/encounters.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fleetmap::exchange {
namespace {

/// So many pairs in a row, found by alignments of before and turned down, say that these are wrong.
constexpr int kDoubtAfter = 5;
/// Odometry frames that lie so far from where they lay are tied by other alignments than before.
constexpr double kOtherPlace = 2.0;  // m
constexpr double kOtherTurn = 0.1;   // rad
/// A search goes through all nodes of a robot, and thousands wait once two long tracks are tied.
constexpr std::size_t kSearchesATick = 20;

bool differ(const Pose& T_before, const Pose& T_now) {
  const Pose T = T_before.inverse() * T_now;
  return T.translation().norm() > kOtherPlace || so3_log(T.linear()).norm() > kOtherTurn;
}

}  // namespace

const char* to_string(EncounterOrder order) {
  return order == EncounterOrder::kWorth ? "worth" : "first_come";
}

Status EncounterConfig::validate() const {
  if (auto status = proximity.validate(); !status) return status;
  if (auto status = lookalikes.validate(); !status) return status;
  if (!(max_sigma_m > 0.0)) return failure("encounters.max_sigma_m must be positive");
  if (!(spacing_m >= 0.0) || !(spacing_aligned_m >= 0.0) || !(spacing_failed_m >= 0.0)) {
    return failure("encounters.spacing_m, spacing_aligned_m and spacing_failed_m must not be negative");
  }
  if (ripe_after < Duration::zero() || retry_after < Duration::zero()) {
    return failure("encounters.ripe_after and retry_after must not be negative");
  }
  if (max_attempts < 1 || max_active == 0 || max_waiting == 0) {
    return failure("encounters.max_attempts, max_active and max_waiting must be at least 1");
  }
  if (!(min_worth >= 0.0)) return failure("encounters.min_worth must not be negative");
  if (peer_timeout <= Duration::zero() || match_period <= Duration::zero() || match_repeats < 0) {
    return failure("encounters.peer_timeout and match_period must be positive, match_repeats not negative");
  }
  return {};
}

Encounters::Encounters(const AgentId& self, const EncounterConfig& config)
    : self_(self), config_(config), lookalikes_(config.lookalikes) {}

bool Encounters::located(const graph::Node& node) const {
  return place::tells_place(node.G, config_.max_sigma_m);
}

void Encounters::on_node(const graph::Node& node, Stamp now) {
  const bool is_located = located(node);
  Spot spot{std::nullopt, node.frame(), node.T_odom_base.translation()};
  if (is_located) spot.position = node.G->position;
  if (!places_.emplace(node.id, spot).second) return;
  Track& track = tracks_[node.id.agent];
  std::uint32_t& newest = track.newest[node.session];
  newest = std::max(newest, node.id.seq);
  ties_.add(node);
  worth_.add(node);
  unlocated_ += !is_located;
  for (const AgentId& other : partners_of(node.id.agent)) find_tied(node.id, other, now);
  if (node.id.seq < newest) search_later(node.id);
  find_alike(node, now);
  if (!is_located || track.tree.insert(node.G->position) == place::BallTree::kRefused) return;
  track.ids.push_back(node.id);
  for (const AgentId& other : partners_of(node.id.agent)) find(node, other, now);
}

void Encounters::forget(const NodeId& node) {
  places_.erase(node);
  std::erase_if(to_search_, [&](const auto& search) { return search.first == node; });
  std::erase_if(encounters_, [&](const auto& entry) {
    const auto& [pair, encounter] = entry;
    if (pair.ours != node && pair.theirs != node) return false;
    if (encounter.phase == Phase::kRegistering) return false;  // its result comes anyway
    if (encounter.phase == Phase::kAsked) withdrawn_.push_back(pair);
    return true;
  });
}

std::vector<AgentId> Encounters::partners_of(const AgentId& agent) const {
  if (agent != self_) return {self_};
  std::vector<AgentId> peers;
  for (const auto& [peer, track] : tracks_) {
    if (peer != self_) peers.push_back(peer);
  }
  return peers;
}

void Encounters::find_alike(const graph::Node& node, Stamp now) {
  const bool is_ours = node.id.agent == self_;
  const auto side = is_ours ? Lookalikes::Side::kOurs : Lookalikes::Side::kTheirs;
  for (const Lookalikes::Pair& alike : lookalikes_.add(node, located(node), side)) {
    ++stats_.alike;
    const NodePair pair = is_ours ? NodePair{alike.fresh, alike.other} : NodePair{alike.other, alike.fresh};
    if (encounters_.contains(pair) || tied(pair)) continue;
    const double likeness = alike.similarity + alike.support;
    replace_less_alike(pair, likeness);
    if (redundant(pair)) {
      ++stats_.redundant;
      continue;
    }
    begin(pair, alike.distance, config_.proximity.max_radius, now, false);
    if (const auto begun = encounters_.find(pair); begun != encounters_.end()) {
      begun->second.likeness = likeness;
    }
  }
}

void Encounters::replace_less_alike(const NodePair& pair, double likeness) {
  for (const NodePair& rival : rivals(pair)) {
    const Encounter& other = encounters_.at(rival);
    if (other.phase != Phase::kWaiting || !other.likeness || *other.likeness >= likeness) continue;
    encounters_.erase(rival);
    ++stats_.redundant;
  }
}

void Encounters::find(const graph::Node& node, const AgentId& other, Stamp now) {
  const auto track = tracks_.find(other);
  if (track == tracks_.end()) return;
  const auto found = place::find_proximity(track->second.tree, *node.G, config_.proximity);
  if (!found) return;
  ++stats_.found;
  const NodeId partner = track->second.ids[found->nearest.index];
  offer(other == self_ ? NodePair{partner, node.id} : NodePair{node.id, partner}, found->nearest.distance,
        found->radius, now);
}

void Encounters::offer(const NodePair& pair, double distance, double radius, Stamp now) {
  if (encounters_.contains(pair)) return;
  const Stamp since = replace_farther(pair, distance, now);
  if (redundant(pair)) {
    ++stats_.redundant;
    return;
  }
  begin(pair, distance, radius, since, false);
}

// ---- by alignments of before
// ------------------------------------------------------------------------------------------------

bool Encounters::goes_by_ties(const NodePair& pair) const {
  return between_unlocated(pair) && !doubted(pair.theirs.agent);
}

bool Encounters::between_unlocated(const NodePair& pair) const {
  const auto ours = places_.find(pair.ours);
  const auto theirs = places_.find(pair.theirs);
  return ours != places_.end() && theirs != places_.end() &&
         !(ours->second.position && theirs->second.position);
}

bool Encounters::doubted(const AgentId& peer) const {
  const auto failures = tied_failures_.find(peer);
  return failures != tied_failures_.end() && failures->second >= kDoubtAfter;
}

void Encounters::doubt(const AgentId& peer) {
  if (++tied_failures_[peer] != kDoubtAfter) return;
  for (auto& [frames, tied] : tied_) {
    if (frames.second.agent == peer) tied.searched = false;
  }
  std::erase_if(encounters_, [&](const auto& entry) {
    return entry.second.phase == Phase::kWaiting && entry.second.by_tie && entry.first.theirs.agent == peer;
  });
}

std::optional<UncertainPose> Encounters::tied(const NodePair& pair) const {
  return goes_by_ties(pair) ? ties_.between(pair.ours, pair.theirs) : std::nullopt;
}

void Encounters::find_tied(const NodeId& node, const AgentId& other, Stamp now) {
  if (unlocated_ == 0) return;
  const auto nearest = ties_.nearest(node, other);
  if (!nearest || nearest->distance > config_.proximity.max_radius) return;
  const NodePair pair = other == self_ ? NodePair{nearest->id, node} : NodePair{node, nearest->id};
  if (!goes_by_ties(pair)) return;
  // The same way round at both ends, so that both come to the same radius.
  const auto T = ties_.between(std::min(pair.ours, pair.theirs), std::max(pair.ours, pair.theirs));
  if (!T) return;
  const double distance = T->T_a_b.translation().head<2>().norm();
  const double radius = place::search_radius(T->covariance, config_.proximity);
  if (distance > radius) return;
  ++stats_.tied;
  offer(pair, distance, radius, now);
  if (const auto begun = encounters_.find(pair); begun != encounters_.end()) begun->second.by_tie = true;
}

void Encounters::search_later(const NodeId& node) {
  if (tied_.empty()) return;
  const std::vector<AgentId> partners = partners_of(node.agent);
  for (auto place = places_.upper_bound(node); place != places_.end() && place->first.agent == node.agent;
       ++place) {
    for (const AgentId& other : partners) to_search_.emplace(place->first, other);
  }
}

void Encounters::search_anew(const graph::FrameTies::FramePair& frames) {
  // What waits is found again, if it is near; what looked alike and failed had another prior.
  std::erase_if(encounters_, [&](const auto& entry) {
    const auto& [pair, encounter] = entry;
    if (encounter.known_to_peer || !between_unlocated(pair)) return false;
    if (places_.at(pair.ours).frame != frames.first || places_.at(pair.theirs).frame != frames.second)
      return false;
    const bool obsolete = (encounter.phase == Phase::kWaiting && (encounter.likeness || encounter.by_tie)) ||
                          (encounter.phase == Phase::kFailed && encounter.likeness && !encounter.by_tie);
    stats_.redundant += obsolete;
    return obsolete;
  });
  for (const auto& [id, spot] : places_) {
    if (spot.frame == frames.first) to_search_.emplace(id, frames.second.agent);
    if (spot.frame == frames.second) to_search_.emplace(id, self_);
  }
}

void Encounters::on_used_alignments(std::span<const graph::Alignment> used) {
  ties_.use(used);
  worth_.use(used);
  if (unlocated_ == 0) return;
  const auto before = std::exchange(tied_, {});
  for (const auto& [frames, T_ours_theirs] : ties_.tied()) {
    const AgentId& peer = frames.second.agent;
    if (frames.first.agent != self_ || peer == self_) continue;
    const auto known = before.find(frames);
    const bool same = known != before.end() && !differ(known->second.T_ours_theirs, T_ours_theirs);
    if (known != before.end() && !same) tied_failures_.erase(peer);
    const bool believed = !doubted(peer);
    tied_.emplace(frames, TiedFrames{T_ours_theirs, believed});
    if (believed && !(same && known->second.searched)) search_anew(frames);
  }
}

std::size_t Encounters::room() const {
  const auto waiting = static_cast<std::size_t>(std::ranges::count_if(
      encounters_, [](const auto& entry) { return entry.second.phase == Phase::kWaiting; }));
  return config_.max_waiting > waiting ? config_.max_waiting - waiting : 0;
}

void Encounters::search_waiting(Stamp now) {
  if (to_search_.empty()) return;
  const std::size_t searches = std::min({kSearchesATick, room(), to_search_.size()});
  for (std::size_t k = 0; k < searches; ++k) {
    const auto [node, other] = *to_search_.begin();
    to_search_.erase(to_search_.begin());
    find_tied(node, other, now);
  }
}

Stamp Encounters::replace_farther(const NodePair& pair, double distance, Stamp now) {
  Stamp since = now;
  for (const NodePair& rival : rivals(pair)) {
    const Encounter& other = encounters_.at(rival);
    if (other.phase != Phase::kWaiting || other.distance <= distance) continue;
    since = std::min(since, other.found);
    encounters_.erase(rival);
    ++stats_.redundant;
  }
  return since;
}

void Encounters::begin(const NodePair& pair, double distance, double radius, Stamp now, bool known_to_peer) {
  if (!places_.contains(pair.ours) || !places_.contains(pair.theirs)) return;  // forgotten
  Encounter encounter;
  encounter.found = now;
  encounter.distance = distance;
  encounter.radius = radius;
  encounter.next_match = now;
  encounter.known_to_peer = known_to_peer;
  encounters_.emplace(pair, encounter);
  crowd_out();
}

double Encounters::spacing(const Encounter& other, const AgentId& peer) const {
  if (other.phase == Phase::kFailed) return config_.spacing_failed_m;
  return aligned_.contains(peer) ? std::max(config_.spacing_m, config_.spacing_aligned_m) : config_.spacing_m;
}

bool Encounters::near(const Spot& a, const Spot& b, double limit) {
  if (a.position && b.position) return haversine_distance(*a.position, *b.position) < limit;
  return a.frame == b.frame && (a.p_odom - b.p_odom).norm() < limit;
}

std::vector<NodePair> Encounters::too_near(const NodePair& pair, std::size_t most) const {
  std::vector<NodePair> found;
  const auto ours = places_.find(pair.ours);
  const auto theirs = places_.find(pair.theirs);
  if (ours == places_.end() || theirs == places_.end()) return found;
  for (const auto& [other, encounter] : encounters_) {
    if (found.size() >= most) break;
    if (other == pair || other.theirs.agent != pair.theirs.agent) continue;
    const double limit = spacing(encounter, pair.theirs.agent);
    const auto other_ours = places_.find(other.ours);
    const auto other_theirs = places_.find(other.theirs);
    if (other_ours != places_.end() && other_theirs != places_.end() &&
        near(ours->second, other_ours->second, limit) && near(theirs->second, other_theirs->second, limit))
      found.push_back(other);
  }
  return found;
}

std::vector<NodePair> Encounters::rivals(const NodePair& pair) const {
  // Without which the pair would not be redundant: there is one at most, where it alone is too near.
  const std::vector<NodePair> nearby = too_near(pair, 2);
  if (nearby.size() != 1) return {};
  const Encounter& only = encounters_.at(nearby.front());
  const bool under_way = only.phase == Phase::kWaiting || only.phase == Phase::kAsked;
  return under_way && !only.known_to_peer ? nearby : std::vector<NodePair>{};
}

void Encounters::on_match(const ProximityMatch& match, Stamp now) {
  const NodePair pair{match.theirs, match.ours};  // the sender's "ours" is our "theirs"
  if (match.to != self_ || pair.ours.agent != self_ || pair.theirs.agent != match.from) return;
  if (const auto known = encounters_.find(pair); known != encounters_.end()) {
    known->second.known_to_peer = true;
    return;
  }
  // Without both nodes there is nothing to compare; when the missing one comes it makes the encounter by
  // itself.
  if (!places_.contains(pair.ours) || !places_.contains(pair.theirs)) return;
  if (!(match.distance <= config_.proximity.max_radius)) return;
  ++stats_.found;
  if (redundant(pair)) {
    // Both ends compare the two pairs in the same order, so both keep the same one.
    const auto order = [](const NodePair& p) { return std::minmax(p.ours, p.theirs); };
    for (const NodePair& rival : rivals(pair)) {
      if (order(rival) < order(pair)) continue;
      stats_.yielded += encounters_.at(rival).phase == Phase::kAsked;
      withdrawn_.push_back(rival);
      encounters_.erase(rival);
    }
  }
  if (redundant(pair)) {
    ++stats_.redundant;
    return;
  }
  begin(pair, match.distance, match.radius, now, true);
}

void Encounters::on_heard(const AgentId& peer, Stamp now) { heard_[peer] = now; }

bool Encounters::heard(const AgentId& peer, Stamp now) const {
  const auto it = heard_.find(peer);
  return it != heard_.end() && now - it->second <= config_.peer_timeout;
}

void Encounters::on_cloud_request(const AgentId& peer, const NodeId& ours) {
  for (auto& [pair, encounter] : encounters_) {
    if (pair.ours == ours && pair.theirs.agent == peer) encounter.known_to_peer = true;
  }
}

void Encounters::on_alignment(const graph::Alignment& alignment, Stamp) {
  if (alignment.best().rmse <= graph::kGoodRmse) worth_.add(alignment);
  const bool first_is_ours = alignment.i.agent == self_;
  if (first_is_ours == (alignment.j.agent == self_)) return;  // between others, or within our own track
  const NodePair pair =
      first_is_ours ? NodePair{alignment.i, alignment.j} : NodePair{alignment.j, alignment.i};
  // An ambiguous one ends the encounter, for the same clouds would be ambiguous again, but it does not yet
  // tell how the two lie.
  const bool good = alignment.best().rmse <= graph::kGoodRmse;
  if (good && !alignment.ambiguous()) aligned_.insert(pair.theirs.agent);
  const bool by_us = alignment.computed_by == self_;
  if (!by_us && !(good && config_.stop_when_peer_aligned)) return;
  if (by_us && !alignment.ambiguous()) tied_failures_.erase(pair.theirs.agent);
  Encounter& encounter = encounters_[pair];  // one from before a restart, or one that the peer alone had
  if (encounter.phase == Phase::kDone) return;
  if (by_us) {
    ++stats_.accepted;
  } else if (encounter.phase == Phase::kRegistering) {
    return;  // the bytes are spent: our own result is welcome as well
  } else if (encounter.phase == Phase::kAsked) {
    ++stats_.settled_by_peer;
    withdrawn_.push_back(pair);
  }
  encounter.phase = Phase::kDone;
}

std::vector<NodePair> Encounters::on_cloud(const NodeId& theirs) {
  std::vector<NodePair> pairs;
  for (auto& [pair, encounter] : encounters_) {
    if (pair.theirs != theirs || encounter.phase != Phase::kAsked) continue;
    encounter.phase = Phase::kRegistering;
    encounter.by_tie = tied(pair).has_value();
    pairs.push_back(pair);
  }
  return pairs;
}

void Encounters::fail(Encounter& encounter, Stamp now) {
  encounter.phase = Phase::kFailed;
  encounter.retry_at = now + config_.retry_after;
}

void Encounters::on_cloud_lost(const NodeId& theirs, Stamp now) {
  for (auto& [pair, encounter] : encounters_) {
    if (pair.theirs != theirs || encounter.phase != Phase::kAsked) continue;
    ++stats_.lost;
    fail(encounter, now);
  }
}

void Encounters::on_rejected(const NodePair& pair, Stamp now) {
  const auto it = encounters_.find(pair);
  if (it == encounters_.end() || it->second.phase != Phase::kRegistering) return;
  ++stats_.rejected;
  if (it->second.by_tie) doubt(pair.theirs.agent);
  fail(it->second, now);
}

void Encounters::crowd_out() {
  std::size_t waiting = 0;
  auto oldest = encounters_.end();
  for (auto it = encounters_.begin(); it != encounters_.end(); ++it) {
    if (it->second.phase != Phase::kWaiting) continue;
    ++waiting;
    if (oldest == encounters_.end() || it->second.found < oldest->second.found) oldest = it;
  }
  if (waiting <= config_.max_waiting) return;
  encounters_.erase(oldest);
  ++stats_.crowded_out;
}

bool Encounters::retryable(const NodePair& pair, const Encounter& encounter) const {
  return encounter.phase == Phase::kFailed && encounter.attempts < config_.max_attempts && !redundant(pair);
}

std::uint32_t Encounters::nodes_since(const NodeId& id) const {
  const auto place = places_.find(id);
  if (place == places_.end()) return 0;
  return tracks_.at(id.agent).newest.at(place->second.frame.session) - id.seq;
}

bool Encounters::ripe(const NodePair& pair, const Encounter& encounter, Stamp now) const {
  if (encounter.phase == Phase::kFailed) return now >= encounter.retry_at;
  if (now >= encounter.found + config_.ripe_after) return true;
  return nodes_since(pair.ours) >= config_.ripe_nodes && nodes_since(pair.theirs) >= config_.ripe_nodes;
}

std::vector<NodePair> Encounters::ready(Stamp now) {
  std::vector<NodePair> ready, obsolete;
  for (const auto& [pair, encounter] : encounters_) {
    // What is cheap to tell first: redundant() looks at all others.
    if (!heard(pair.theirs.agent, now) || !ripe(pair, encounter, now)) continue;
    if (encounter.phase != Phase::kWaiting && !retryable(pair, encounter)) continue;
    // The spacing grows with the first good alignment.
    const bool is_obsolete =
        encounter.phase == Phase::kWaiting && !encounter.known_to_peer && redundant(pair);
    (is_obsolete ? obsolete : ready).push_back(pair);
  }
  for (const NodePair& pair : obsolete) {
    // Of two that make each other redundant one stays.
    if (redundant(pair)) {
      encounters_.erase(pair);
      ++stats_.redundant;
    } else {
      ready.push_back(pair);
    }
  }
  return ready;
}

std::optional<Encounters::Choice> Encounters::choose(std::vector<NodePair>& ready, bool radio_has_room) {
  std::vector<graph::AlignmentWorth::Pair> pairs, expected;
  for (const NodePair& pair : ready) pairs.emplace_back(pair.ours, pair.theirs);
  for (const auto& [pair, encounter] : encounters_) {
    if (encounter.phase == Phase::kAsked || encounter.phase == Phase::kRegistering)
      expected.emplace_back(pair.ours, pair.theirs);
  }
  const std::vector<double> worths = worth_.of(pairs, expected);
  std::optional<std::size_t> best;
  std::vector<NodePair> left;
  const auto before = [&](std::size_t a, std::size_t b) {
    const Stamp found_a = encounters_.at(ready[a]).found, found_b = encounters_.at(ready[b]).found;
    if (config_.order == EncounterOrder::kFirstCome) return found_a < found_b;
    return std::tuple(worths[a], found_a) > std::tuple(worths[b], found_b);
  };
  for (std::size_t k = 0; k < ready.size(); ++k) {
    if (worths[k] < config_.min_worth && !radio_has_room) {
      encounters_.erase(ready[k]);
      ++stats_.worthless;
    } else if (!best || before(k, *best)) {
      if (best) left.push_back(ready[*best]);
      best = k;
    } else {
      left.push_back(ready[k]);
    }
  }
  std::optional<Choice> choice;
  if (best) choice = Choice{ready[*best], worths[*best]};
  ready = std::move(left);
  return choice;
}

void Encounters::ask(Due& due, Stamp now, bool radio_has_room) {
  // A robot that fell silent must not keep the others waiting for its clouds.
  auto active = static_cast<std::size_t>(std::ranges::count_if(encounters_, [&](const auto& entry) {
    const auto& [pair, encounter] = entry;
    return (encounter.phase == Phase::kAsked && heard(pair.theirs.agent, now)) ||
           encounter.phase == Phase::kRegistering;
  }));
  if (active >= config_.max_active) return;
  for (std::vector<NodePair> waiting = ready(now); !waiting.empty() && active < config_.max_active;) {
    const auto choice = choose(waiting, radio_has_room);
    if (!choice) return;
    Encounter& encounter = encounters_.at(choice->pair);
    encounter.phase = Phase::kAsked;
    ++encounter.attempts;
    ++stats_.begun;
    ++active;
    due.wanted.push_back({choice->pair.theirs, choice->worth});
    // The place that was chosen may make others redundant.
    std::erase_if(waiting, [&](const NodePair& pair) {
      const Encounter& other = encounters_.at(pair);
      if (other.phase != Phase::kWaiting || other.known_to_peer || !redundant(pair)) return false;
      encounters_.erase(pair);
      ++stats_.redundant;
      return true;
    });
  }
}

void Encounters::announce(Due& due, Stamp now) {
  for (auto& [pair, encounter] : encounters_) {
    if (encounter.phase != Phase::kAsked || encounter.known_to_peer) continue;
    if (encounter.matches_sent >= config_.match_repeats || now < encounter.next_match) continue;
    ++encounter.matches_sent;
    encounter.next_match = now + config_.match_period;
    due.matches.push_back(
        {self_, pair.theirs.agent, pair.theirs, pair.ours, encounter.distance, encounter.radius});
  }
}

Encounters::Due Encounters::tick(Stamp now, bool radio_has_room) {
  Due due;
  search_waiting(now);
  ask(due, now, radio_has_room);
  announce(due, now);
  std::swap(due.withdrawn, withdrawn_);
  return due;
}

bool Encounters::wants(const NodeId& theirs) const {
  return std::ranges::any_of(encounters_, [&](const auto& entry) {
    return entry.first.theirs == theirs && entry.second.phase == Phase::kAsked;
  });
}

bool Encounters::idle(Stamp now, const std::set<AgentId>& without) const {
  if (!to_search_.empty() && room() > 0) return false;
  return std::ranges::none_of(encounters_, [&](const auto& entry) {
    const auto& [pair, encounter] = entry;
    if (without.contains(pair.theirs.agent)) return false;
    const bool busy = encounter.phase == Phase::kAsked || encounter.phase == Phase::kRegistering;
    if (busy) return true;
    return heard(pair.theirs.agent, now) &&
           (encounter.phase == Phase::kWaiting || retryable(pair, encounter));
  });
}

}  // namespace fleetmap::exchange
