#include "reconcile.hpp"

#include <algorithm>

#include "digest_part.hpp"

namespace fleetmap::exchange {
namespace {

using store::SeqSet;

std::uint64_t count(const std::vector<SeqRange>& ranges) {
  std::uint64_t items = 0;
  for (const SeqRange& range : ranges) items += range.end - range.first;
  return items;
}

/// Rotates the ranges, so that an undelivered offer does not keep others from being requested.
std::vector<SeqRange> rotated(std::vector<SeqRange> ranges, int turns) {
  if (ranges.empty()) return ranges;
  const auto first = static_cast<std::ptrdiff_t>(static_cast<std::size_t>(turns) % ranges.size());
  std::rotate(ranges.begin(), ranges.begin() + first, ranges.end());
  return ranges;
}

/// The first `items` of `ranges`.
std::vector<SeqRange> first_items(std::vector<SeqRange> ranges, std::uint64_t items) {
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (items == 0) {
      ranges.resize(k);
      break;
    }
    ranges[k].end = ranges[k].first + static_cast<std::uint32_t>(
                                          std::min<std::uint64_t>(items, ranges[k].end - ranges[k].first));
    items -= ranges[k].end - ranges[k].first;
  }
  return ranges;
}

/// Whether everything offered is held, except undelivered items.
bool holds_all(const SeqSet& held, const SeqSet& offered, const SeqSet& undelivered) {
  return undelivered.empty() ? held.includes(offered) : held.includes(SeqSet(offered.minus(undelivered)));
}

SeqSet joined(SeqSet a, const SeqSet& b) {
  for (const SeqRange& range : b.ranges()) a.insert(range);
  return a;
}

}  // namespace

Reconcile::Reconcile(const AgentId& self, const ReconcileConfig& config)
    : self_(self), config_(config), period_(config.digest_min_period) {}

SeqSet Reconcile::requested(const std::vector<SeqRange>& ranges) {
  SeqSet set;
  for (const SeqRange& range : ranges) {
    if (!range.agent.empty() && range.first < range.end && range.end <= kEndOfSeqs) {
      set.insert(range);
    } else {
      ++stats_.hostile;
    }
  }
  return set;
}

void Reconcile::on_heard(const AgentId& peer, Stamp now) { peers_[peer].heard = now; }

void Reconcile::on_store_failure(Stamp now) {
  if (paused_until_ && now < *paused_until_) return;
  store_pause_ = std::clamp(2 * store_pause_, config_.store_pause, config_.max_store_pause);
  paused_until_ = now + store_pause_;
}

void Reconcile::on_item(Stamp now) {
  store_pause_ = Duration::zero();
  hurry(now);
}

void Reconcile::hurry(Stamp now) {
  period_ = config_.digest_min_period;
  if (last_digest_)
    next_digest_ = std::min(next_digest_.value_or(now), std::max(now, *last_digest_ + period_));
}

void Reconcile::on_digest(const Digest& digest, const store::Store& store, Stamp now) {
  if (digest.from == self_ || digest.from.empty()) return;
  ++stats_.digests_heard;
  Peer& peer = peers_[digest.from];
  peer.heard = now;
  const auto offer = [this](SeqSet& offered, const std::vector<SeqRange>& ranges) {
    const std::vector<SeqRange> part = plausible(ranges, stats_.hostile);
    offered = ranges.size() < config_.max_ranges ? SeqSet(part) : offered_after(offered, part);
  };
  offer(peer.offer.nodes, digest.nodes);
  offer(peer.offer.alignments, digest.alignments);
  if (check_.on_digest(digest, store, now)) hurry(now);
  const bool lacking =
      !store.node_set().includes(peer.offer.nodes) || !store.alignment_set().includes(peer.offer.alignments);
  if (lacking && !peer.offer.lacking) peer.offer.since = now;
  peer.offer.lacking = lacking;
  peer.resting_until = now;
  // A robot that lacks something receives our digest soon.
  if (!peer.offer.nodes.includes(store.node_set()) || !peer.offer.alignments.includes(store.alignment_set()))
    hurry(now);
}

void Reconcile::on_contested(Stamp now) {
  check_.on_contested();
  hurry(now);
}

Reconcile::Items Reconcile::answer(const ItemRequest& request, const store::Store& store) {
  Items items;
  if (request.to != self_) return items;
  ++stats_.requests_served;
  std::uint32_t left = config_.max_items;
  for (const SeqRange& range : requested(request.nodes).ranges()) {
    for (auto it = store.nodes().lower_bound({range.agent, range.first});
         it != store.nodes().end() && it->first.agent == range.agent && it->first.seq < range.end && left > 0;
         ++it, --left) {
      items.nodes.push_back(&it->second);
    }
    for (const auto& [first, second] : store.contested_nodes(range)) {
      if (left < 2) break;
      left -= 2;
      items.nodes.push_back(first);
      items.second_nodes.push_back(second);
    }
  }
  for (const SeqRange& range : requested(request.alignments).ranges()) {
    for (const auto& [first, second] : store.contested_alignments(range)) {
      if (left < 2) break;
      left -= 2;
      items.alignments.push_back(first);
      items.second_alignments.push_back(second);
    }
    const auto& alignments = store.alignments();
    for (auto it = alignments.lower_bound({range.agent, range.first});
         it != alignments.end() && it->first.computed_by == range.agent && it->first.seq < range.end &&
         left > 0;
         ++it, --left) {
      items.alignments.push_back(&it->second);
    }
  }
  stats_.items_served += items.nodes.size() + items.alignments.size();
  return items;
}

void Reconcile::update_pending(Peer& peer, const store::Store& store, Stamp now) {
  if (!peer.pending) return;
  Pending& pending = *peer.pending;
  const std::uint64_t left =
      count(pending.nodes.minus(store.node_set())) + count(pending.alignments.minus(store.alignment_set()));
  if (left == 0) {
    peer.pending.reset();
    peer.rest = Duration::zero();
    peer.barren = 0;
  } else if (left < pending.left) {
    pending.left = left;
    peer.barren = 0;
    pending.deadline = now + config_.timeout;
  } else if (now >= pending.deadline) {
    ++stats_.timeouts;
    peer.pending.reset();
    ++peer.barren;
    // Another agent may have the same; this one waits longer every time it brings nothing, until its next
    // digest.
    peer.rest = std::min(std::max(2 * peer.rest, config_.grace), config_.digest_max_period);
    peer.resting_until = now + peer.rest;
  }
}

void Reconcile::update_undelivered(const AgentId& name, Peer& peer, const store::Store& store, Due& due) {
  Offer& offer = peer.offer;
  const auto delivered = [](const SeqSet& undelivered, const SeqSet& held) {
    return count(undelivered.minus(held)) < undelivered.size();
  };
  if (delivered(offer.undelivered_nodes, store.node_set()) ||
      delivered(offer.undelivered_alignments, store.alignment_set())) {
    offer.undelivered_nodes = {};
    offer.undelivered_alignments = {};
    peer.barren = 0;
    peer.undelivered_reported = false;
  }
  if (peer.barren < config_.max_barren || peer.pending) return;
  offer.undelivered_nodes = SeqSet(offer.nodes.minus(store.node_set()));
  offer.undelivered_alignments = SeqSet(offer.alignments.minus(store.alignment_set()));
  if (peer.undelivered_reported || (offer.undelivered_nodes.empty() && offer.undelivered_alignments.empty()))
    return;
  peer.undelivered_reported = true;
  due.undelivered.push_back({name, offer.undelivered_nodes.size(), offer.undelivered_alignments.size()});
}

std::optional<ItemRequest> Reconcile::ask(const AgentId& name, Peer& peer, const store::Store& store,
                                          Stamp now) {
  const Offer& offer = peer.offer;
  if (paused_until_ && now < *paused_until_) return {};
  if (peer.pending || !offer.lacking || now < offer.since + config_.grace || now < peer.resting_until)
    return {};
  if (now - peer.heard > config_.peer_timeout) return {};
  SeqSet known_nodes = store.node_set();
  SeqSet known_alignments = store.alignment_set();
  for (const auto& [other, other_peer] : peers_) {
    if (!other_peer.pending) continue;
    known_nodes = joined(std::move(known_nodes), other_peer.pending->nodes);
    known_alignments = joined(std::move(known_alignments), other_peer.pending->alignments);
  }
  ItemRequest request{self_, name, {}, {}};
  const auto some = [&](const SeqSet& offered, const SeqSet& known, std::uint64_t max_items) {
    return next_part(first_items(rotated(offered.minus(known), peer.barren), max_items), 0,
                     config_.max_ranges);
  };
  request.nodes = some(offer.nodes, known_nodes, config_.max_items);
  request.alignments = some(offer.alignments, known_alignments, config_.max_items - count(request.nodes));
  if (request.nodes.empty() && request.alignments.empty()) return {};
  Pending pending{SeqSet(request.nodes), SeqSet(request.alignments), 0, now + config_.timeout};
  pending.left = pending.nodes.size() + pending.alignments.size();
  peer.pending = std::move(pending);
  ++stats_.requests_sent;
  return request;
}

Digest Reconcile::digest_of(const store::Store& store, NextPart& next) const {
  Digest digest{self_, {}, {}};
  const auto nodes = check_.cut(by_session(store.node_set().ranges()), false);
  const auto alignments = check_.cut(by_session(store.alignment_set().ranges()), true);
  digest.nodes = next_part(nodes, next.nodes, config_.max_ranges);
  digest.alignments = next_part(alignments, next.alignments, config_.max_ranges);
  for (const SeqRange& range : digest.nodes) digest.node_prints.push_back(store.node_print(range));
  for (const SeqRange& range : digest.alignments)
    digest.alignment_prints.push_back(store.alignment_print(range));
  next.nodes = after_part(next.nodes, nodes.size(), config_.max_ranges);
  next.alignments = after_part(next.alignments, alignments.size(), config_.max_ranges);
  return digest;
}

Reconcile::Due Reconcile::tick(const store::Store& store, Stamp now) {
  Due due;
  if (!next_digest_ || now >= *next_digest_) {
    due.digest = digest_of(store, next_part_);
    ++stats_.digests_sent;
    last_digest_ = now;
    next_digest_ = now + period_;
    period_ = std::min(2 * period_, config_.digest_max_period);
  }
  check_.expire(now);
  for (auto& [name, peer] : peers_) {
    update_pending(peer, store, now);
    update_undelivered(name, peer, store, due);
    if (!peer.offer.lacking) continue;
    peer.offer.lacking = !store.node_set().includes(peer.offer.nodes) ||
                         !store.alignment_set().includes(peer.offer.alignments);
  }
  for (auto& [name, peer] : peers_) {
    if (auto request = ask(name, peer, store, now)) {
      due.requests.push_back(std::move(*request));
    } else if (!peer.pending) {
      if (auto check = check_.ask(self_, name, now)) due.requests.push_back(std::move(*check));
    }
  }
  return due;
}

bool Reconcile::complete(const store::Store& store, const std::set<AgentId>& without) const {
  return std::ranges::all_of(peers_, [&](const auto& entry) {
    if (without.contains(entry.first)) return true;
    const Offer& offer = entry.second.offer;
    return holds_all(store.node_set(), offer.nodes, offer.undelivered_nodes) &&
           holds_all(store.alignment_set(), offer.alignments, offer.undelivered_alignments);
  });
}

bool Reconcile::caught_up(const AgentId& name, const store::Store& store) const {
  const auto peer = peers_.find(name);
  return peer != peers_.end() && peer->second.offer.nodes.includes(store.node_set()) &&
         peer->second.offer.alignments.includes(store.alignment_set());
}

}  // namespace fleetmap::exchange
