#include "submap_receiver.hpp"

#include <algorithm>
#include <cmath>

#include "chunk_size.hpp"

namespace fleetmap::exchange {
namespace {

static_assert(kChunk == SubmapChunk::kMaxPayload);
/// A download without any arrival for so many of the longest timeouts is stopped.
constexpr int kSilentTimeouts = 3;
constexpr std::uint64_t kMaxMissing = 4096;  ///< submaps examined in one tick

/// A peer that answers nothing keeps the least of its own window under way: there is room for others beside
/// it.
DelayWindowConfig of_all(DelayWindowConfig config) {
  config.min_bytes = std::min(2 * config.min_bytes, config.first_bytes);
  return config;
}

}  // namespace

SubmapReceiver::SubmapReceiver(const AgentId& self, const SubmapTransferConfig& config)
    : self_(self), config_(config), neighbours_(self, config), window_(of_all(config.window)) {}

std::uint32_t SubmapReceiver::chunk_bytes(const graph::Node& node, std::uint32_t chunk) {
  return std::min(kChunk, node.submap_bytes - chunk * kChunk);
}

void SubmapReceiver::on_heard(const AgentId& name, Stamp now) {
  if (!neighbours_.in_reach(name, now)) {
    // The two have moved: what was measured of the link no longer holds.
    if (neighbours_.in_reach(now).empty()) window_ = DelayWindow(of_all(config_.window));
    Peer& peer = this->peer(name);
    peer.window = DelayWindow(config_.window);
    peer.base_delay = {};
  }
  neighbours_.on_heard(name, now);
}

void SubmapReceiver::on_digest(const SubmapDigest& digest, Stamp now) {
  on_heard(digest.from, now);
  neighbours_.on_digest(digest, now);
}

std::vector<AgentId> SubmapReceiver::asked() const {
  std::vector<AgentId> names;
  for (const auto& [name, peer] : peers_) {
    if (peer.bytes_out > 0) names.push_back(name);
  }
  return names;
}

SubmapReceiverStats SubmapReceiver::stats() const {
  SubmapReceiverStats all = stats_;
  all.hostile += neighbours_.hostile_ranges();
  return all;
}

Duration SubmapReceiver::timeout(const Peer& peer) const {
  return std::clamp(from_seconds(peer.delay + 4.0 * peer.spread), config_.min_timeout, config_.max_timeout);
}

void SubmapReceiver::on_arrival(Peer& peer, Download& download, std::uint32_t chunk, Stamp now) {
  peer.last_chunk = download.last_arrival = now;
  const auto flight = download.flights.find(chunk);
  if (flight == download.flights.end()) return;
  const double delay = to_seconds(now - flight->second.sent);
  if (peer.answered == 0) {
    peer.delay = delay;
    peer.spread = delay / 2.0;
  }
  peer.spread += 0.25 * (std::abs(delay - peer.delay) - peer.spread);
  peer.delay += 0.125 * (delay - peer.delay);
  const double queueing = peer.base_delay.queueing_of(delay, now);
  peer.window.on_arrival(queueing, flight->second.bytes);
  window_.on_arrival(queueing, flight->second.bytes);
  no_longer_out(peer, flight->second.bytes);
  peer.answered = std::max(peer.answered, flight->second.order);
  download.flights.erase(flight);
}

bool SubmapReceiver::is_lost(const Flight& flight, const Peer& peer, Stamp now) const {
  // As RACK (RFC 8985): a chunk requested later has arrived, and this one takes longer than usual.
  constexpr std::uint64_t kOvertaken = 3;
  const bool overtaken = flight.order + kOvertaken < peer.answered;
  if (overtaken && to_seconds(now - flight.sent) > peer.delay + 4.0 * peer.spread) return true;
  // As long as others arrive, this one may still be queued at the peer.
  return now >= std::max(flight.deadline, peer.last_chunk + timeout(peer) / 2);
}

bool SubmapReceiver::distrusts(const AgentId& name, const NodeId& id, Stamp now) const {
  const auto distrusted = distrusted_.find({id, name});
  return distrusted != distrusted_.end() && now < distrusted->second.until;
}

void SubmapReceiver::distrust(const AgentId& name, const NodeId& id, Stamp now) {
  Distrust& distrust = distrusted_[{id, name}];
  distrust.length = std::clamp(2 * distrust.length, config_.first_distrust, config_.max_distrust);
  distrust.until = now + distrust.length;
}

void SubmapReceiver::on_store_failure(Stamp now) {
  paused_until_ = now + config_.store_pause;
  while (!downloads_.empty()) stop(downloads_.begin());
}

Result<std::optional<NodeId>> SubmapReceiver::on_chunk(const SubmapChunk& chunk, store::Store& store,
                                                       Stamp now) {
  const graph::Node* node = store.node(chunk.node);
  const std::uint32_t index = chunk.offset / kChunk;
  if (!node || chunk.to != self_ || chunk.total_bytes != node->submap_bytes || chunk.offset % kChunk != 0 ||
      chunk.offset >= node->submap_bytes || chunk.payload.size() != chunk_bytes(*node, index)) {
    ++stats_.hostile;
    return std::optional<NodeId>();
  }
  const auto download = downloads_.find(chunk.node);
  if (download == downloads_.end() || download->second.peer != chunk.from ||
      !download->second.asked.contains(index)) {
    ++stats_.unasked;
    return std::optional<NodeId>();
  }
  on_arrival(peer(chunk.from), download->second, index, now);
  const std::uint64_t bad_before = store.stats().bad_submaps;
  const auto put = store.put_submap_chunk(chunk.node, index, chunk.payload);
  if (!put) {
    on_store_failure(now);
    return tl::unexpected(put.error());
  }
  if (*put == store::Put::kKnown) ++stats_.duplicates;
  if (*put == store::Put::kAdded) {
    ++stats_.chunks;
    sources_[chunk.node].insert(chunk.from);
  }
  const bool wrong = store.stats().bad_submaps > bad_before;
  if (wrong) {
    ++stats_.bad_hash;
    sources_[chunk.node].insert(chunk.from);
    // With one source it is the culprit; with several the next download, from one peer alone, will show. A
    // chunk may have been forged or damaged on its way, so the peer is asked again later.
    if (sources_[chunk.node].size() == 1) distrust(chunk.from, chunk.node, now);
  }
  const bool whole = *put == store::Put::kAdded && store.has_submap(chunk.node);
  if (whole || wrong) {
    sources_.erase(chunk.node);
    stop(download);
  }
  if (!whole) return std::optional<NodeId>();
  on_whole(chunk.node);
  return std::optional<NodeId>(chunk.node);
}

void SubmapReceiver::on_whole(const NodeId& id) {
  std::erase_if(distrusted_, [&](const auto& entry) { return entry.first.first == id; });
  ++stats_.submaps;
}

SubmapReceiver::Finished SubmapReceiver::finish_downloads(store::Store& store, Stamp now) {
  Finished finished;
  if (!paused_until_ || now < *paused_until_) return finished;
  paused_until_.reset();
  for (const NodeId& id : store.partial_submaps()) {
    if (!store.missing_chunks(id).empty()) continue;
    const auto put = store.finish_download(id);
    if (!put) {
      on_store_failure(now);
      finished.failure = put.error();
      return finished;
    }
    sources_.erase(id);
    if (*put == store::Put::kAdded) {
      finished.submaps.push_back(id);
      on_whole(id);
    } else {
      ++stats_.bad_hash;
    }
  }
  return finished;
}

void SubmapReceiver::stop(std::map<NodeId, Download>::iterator download) {
  // Bytes still on their way no longer count against the window.
  Peer& peer = this->peer(download->second.peer);
  for (const auto& [chunk, flight] : download->second.flights) no_longer_out(peer, flight.bytes);
  downloads_.erase(download);
}

void SubmapReceiver::expire(const store::Store& store, Stamp now) {
  for (auto it = downloads_.begin(); it != downloads_.end();) {
    const auto current = it++;
    Download& download = current->second;
    Peer& peer = this->peer(download.peer);
    const bool silent = now - download.last_arrival > kSilentTimeouts * config_.max_timeout;
    // It may have lost the submap, or not hear us: another may have it.
    if (silent) distrust(download.peer, current->first, now);
    // A node whose name became contested has no submap any more.
    const bool over = store.has_submap(current->first) || !store.node(current->first);
    if (silent || over || !neighbours_.in_reach(download.peer, now)) {
      stop(current);
      continue;
    }
    for (auto flight = download.flights.begin(); flight != download.flights.end();) {
      if (!is_lost(flight->second, peer, now)) {
        ++flight;
        continue;
      }
      ++stats_.timeouts;
      peer.window.on_loss(flight->second.sent, now);
      // Losses of one peer at the edge of reach are not evidence of congestion of the shared channel.
      if (window_.queues()) {
        window_.on_loss(flight->second.sent, now);
      } else {
        window_.end_slow_start();
      }
      no_longer_out(peer, flight->second.bytes);
      flight = download.flights.erase(flight);
    }
  }
}

std::vector<NodeId> SubmapReceiver::missing(const store::Store& store, Stamp now) const {
  // Partial downloads are finished first.
  const std::vector<NodeId> begun = store.partial_submaps();
  std::vector<NodeId> ids = begun;
  const store::SeqSet lacking(store.node_set().minus(store.submap_set()));
  // Submaps that no robot offers must not keep others from being requested.
  const store::SeqSet offered = neighbours_.offered(lacking, kMaxMissing, now);
  for (const SeqRange& range : offered.minus({}, kMaxMissing)) {
    for (std::uint32_t seq = range.first; seq < range.end; ++seq) {
      const NodeId id{range.agent, seq};
      if (store.node(id) && !std::ranges::binary_search(begun, id)) ids.push_back(id);
    }
  }
  return ids;
}

bool SubmapReceiver::may_serve(const AgentId& name, const NodeId& id, Stamp now) const {
  return neighbours_.hears_us(name, now) && neighbours_.holds(name, id) && !distrusts(name, id, now);
}

bool SubmapReceiver::any_has_room(Stamp now) const {
  return std::ranges::any_of(peers_, [&](const auto& entry) {
    return neighbours_.in_reach(entry.first, now) && has_room(entry.second, kChunk);
  });
}

void SubmapReceiver::no_longer_out(Peer& peer, std::uint32_t bytes) {
  peer.bytes_out -= bytes;
  bytes_out_ -= bytes;
}

bool SubmapReceiver::assign(const store::Store& store, const NodeId& id, Stamp now) {
  if (downloads_.contains(id) || store.has_submap(id)) return false;
  const AgentId* best = nullptr;
  for (const auto& [name, peer] : peers_) {
    if (!may_serve(name, id, now) || !has_room(peer, kChunk)) continue;
    if (!best || peer.bytes_out < peers_.at(*best).bytes_out) best = &name;
  }
  if (!best) return false;
  downloads_[id] = {*best, now, {}, {}};
  return true;
}

void SubmapReceiver::fill(const store::Store& store, const NodeId& id, Download& download, Stamp now,
                          std::vector<SubmapRequest>& requests) {
  const graph::Node& node = *store.node(id);
  Peer& peer = this->peer(download.peer);
  for (const std::uint32_t chunk : store.missing_chunks(id)) {
    if (download.flights.contains(chunk)) continue;
    const std::uint32_t bytes = chunk_bytes(node, chunk);
    if (!has_room(peer, bytes)) return;
    peer.bytes_out += bytes;
    bytes_out_ += bytes;
    download.asked.insert(chunk);
    download.flights[chunk] = {bytes, ++peer.asked, now, now + timeout(peer)};
    const bool extends = !requests.empty() && requests.back().node == id &&
                         requests.back().to == download.peer &&
                         requests.back().offset + requests.back().length == chunk * kChunk &&
                         requests.back().length + bytes <= config_.request_bytes;
    if (extends) {
      requests.back().length += bytes;
    } else {
      requests.push_back({self_, download.peer, id, chunk * kChunk, bytes});
    }
  }
}

std::vector<SubmapRequest> SubmapReceiver::tick(const store::Store& store, Stamp now) {
  expire(store, now);
  std::vector<SubmapRequest> requests;
  if (paused_until_) return requests;
  for (auto& [id, download] : downloads_) fill(store, id, download, now, requests);
  if (any_has_room(now) && store.submap_set().size() < store.node_set().size()) {
    for (const NodeId& id : missing(store, now)) {
      if (assign(store, id, now)) fill(store, id, downloads_.at(id), now, requests);
    }
  }
  stats_.requests += requests.size();
  return requests;
}

bool SubmapReceiver::idle(const store::Store& store, Stamp now) const {
  if (!downloads_.empty()) return false;
  return std::ranges::none_of(missing(store, now), [&](const NodeId& id) {
    return std::ranges::any_of(peers_, [&](const auto& peer) { return may_serve(peer.first, id, now); });
  });
}

}  // namespace fleetmap::exchange
