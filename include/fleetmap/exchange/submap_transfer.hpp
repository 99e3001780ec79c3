#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/delay_window.hpp"
#include "fleetmap/exchange/token_bucket.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::SubmapChunk;
using messages::SubmapDigest;
using messages::SubmapRequest;

struct SubmapTransferConfig {
  double bytes_per_second = 1'875'000;   ///< B/s that this agent sends at most: a link of 15 Mbit/s
  double burst_bytes = 131'072;          ///< B; at least bytes_per_second times the time between two ticks
  std::size_t overhead_bytes = 540;      ///< B a chunk: headers of its three datagrams of two IP packets each
  DelayWindowConfig window;              ///< B asked for and not yet here, of one peer and of all
  std::uint32_t request_bytes = 65'536;  ///< B asked for by one message at most
  Duration digest_period = std::chrono::seconds(1);
  Duration peer_timeout = std::chrono::seconds(4);        ///< s, a peer not heard for so long is out of reach
  Duration min_timeout = std::chrono::milliseconds(300);  ///< of a chunk; the measured delay raises it
  Duration max_timeout = std::chrono::seconds(3);
  /// A peer that gave wrong content of a submap is not asked for it for so long, then twice as long, and so
  /// on.
  Duration first_distrust = std::chrono::seconds(10);
  Duration max_distrust = std::chrono::minutes(5);
  Duration store_pause =
      std::chrono::seconds(5);  ///< nothing is asked for after the store failed (disk full)
  std::size_t max_ranges = 64;  ///< in a digest
  std::size_t max_queued_chunks =
      256;  ///< waiting for one peer; more requests are dropped and asked for again
  Status validate() const;
};

struct SubmapReceiverStats {
  std::uint64_t requests = 0;
  std::uint64_t chunks = 0;      ///< that brought something new
  std::uint64_t duplicates = 0;  ///< held already
  std::uint64_t timeouts = 0;    ///< chunks asked for again
  std::uint64_t hostile = 0;     ///< chunks and ranges that contradict the node or the rules
  std::uint64_t unasked = 0;     ///< chunks of what was not asked for, or of another peer
  std::uint64_t bad_hash = 0;    ///< whole submaps with the wrong content
  std::uint64_t submaps = 0;     ///< completed
};

/// Fetches the submaps that this agent lacks from whoever is within reach and has them, maker or not. Keeps a
/// window of chunks under way from each peer, since each may be behind another path, and one from all of
/// them, since they mostly share a channel; never asks two peers for one chunk at the same time; goes on
/// where it stopped.
class SubmapReceiver {
 public:
  SubmapReceiver(const AgentId& self, const SubmapTransferConfig& config);

  void on_digest(const SubmapDigest& digest, Stamp now);
  /// Any short-range message came from `peer`.
  void on_heard(const AgentId& peer, Stamp now);
  /// The completed submap, if `chunk` was its last. An Error is the store's.
  Result<std::optional<NodeId>> on_chunk(const SubmapChunk& chunk, store::Store& store, Stamp now);
  std::vector<SubmapRequest> tick(const store::Store& store, Stamp now);
  /// Submaps whose chunks are all here, but which the store could not complete: tries again after a pause.
  struct Finished {
    std::vector<NodeId> submaps;
    std::optional<Error> failure;  ///< of the store
  };
  Finished finish_downloads(store::Store& store, Stamp now);

  bool in_reach(const AgentId& peer, Stamp now) const;
  /// It is in reach, and its last digest named us as heard.
  bool hears_us(const AgentId& peer, Stamp now) const;
  /// Most of its digests of the last peer_timeout came and named us: what is sent over this link arrives.
  bool is_near(const AgentId& peer, Stamp now) const;
  /// `peer` was heard, and told of no such submap.
  bool lacks(const AgentId& peer, const NodeId& id) const;
  /// The same, by a digest that came after `since`.
  bool lacks_since(const AgentId& peer, const NodeId& id, Stamp since) const;
  std::vector<AgentId> peers_in_reach(Stamp now) const;
  /// Peers that chunks are under way from.
  std::vector<AgentId> asked() const;
  /// Peers in reach that told of all submaps held here and of no others.
  std::vector<AgentId> even_with(const store::Store& store, Stamp now) const;
  /// Nothing is under way, and no peer in reach has what we lack.
  bool idle(const store::Store& store, Stamp now) const;
  std::size_t peers() const { return peers_.size(); }
  std::size_t downloads() const { return downloads_.size(); }
  const SubmapReceiverStats& stats() const { return stats_; }

 private:
  struct Flight {
    std::uint32_t bytes = 0;
    std::uint64_t order = 0;  ///< of all chunks asked of the peer
    Stamp sent;
    Stamp deadline;
  };
  struct Peer {
    explicit Peer(const DelayWindowConfig& config) : window(config) {}
    bool has_room(std::uint32_t bytes) const { return bytes_out + bytes <= window.bytes(); }
    store::SeqSet holds;  ///< as of its last digests
    Stamp told;           ///< when the last one came
    DelayWindow window;
    LeastDelay least_delay;
    Stamp heard;
    bool hears_us = false;
    std::deque<Stamp> heard_by_it;  ///< digests of the last peer_timeout that named us
    std::uint64_t bytes_out = 0;    ///< asked for and not yet here
    double delay = 0.0;             ///< s, smoothed, from request to chunk
    double spread = 0.0;            ///< s, its smoothed deviation
    Stamp last_chunk;
    std::uint64_t asked = 0;     ///< chunks
    std::uint64_t answered = 0;  ///< the latest asked for of those that came
  };
  struct Download {
    AgentId peer;  ///< one submap comes from one peer at a time, so that a wrong one is known by its source
    Stamp last_arrival;                       ///< or when it was begun
    std::map<std::uint32_t, Flight> flights;  ///< by chunk
    std::set<std::uint32_t> asked;            ///< chunks, also those that were given up
  };
  struct Distrust {
    Stamp until;
    Duration length = Duration::zero();
  };
  Peer& peer(const AgentId& name) { return peers_.try_emplace(name, config_.window).first->second; }
  bool distrusts(const AgentId& name, const NodeId& id, Stamp now) const;
  Duration timeout(const Peer& peer) const;
  bool is_lost(const Flight& flight, const Peer& peer, Stamp now) const;
  void on_arrival(Peer& peer, Download& download, std::uint32_t chunk, Stamp now);
  void on_whole(const NodeId& id);
  void on_store_failure(Stamp now);
  void distrust(const AgentId& name, const NodeId& id, Stamp now);
  void expire(const store::Store& store, Stamp now);
  void stop(std::map<NodeId, Download>::iterator download);
  bool has_room(const Peer& peer, std::uint32_t bytes) const {
    return peer.has_room(bytes) && bytes_out_ + bytes <= window_.bytes();
  }
  bool any_has_room(Stamp now) const;
  void no_longer_out(Peer& peer, std::uint32_t bytes);
  bool assign(const store::Store& store, const NodeId& id, Stamp now);
  void fill(const store::Store& store, const NodeId& id, Download& download, Stamp now,
            std::vector<SubmapRequest>& requests);
  std::vector<NodeId> missing(const store::Store& store, Stamp now) const;
  bool may_serve(const AgentId& name, const Peer& peer, const NodeId& id, Stamp now) const;
  static std::uint32_t chunk_bytes(const graph::Node& node, std::uint32_t chunk);

  AgentId self_;
  SubmapTransferConfig config_;
  DelayWindow window_;           ///< of all peers together
  std::uint64_t bytes_out_ = 0;  ///< of all peers together
  std::map<AgentId, Peer> peers_;
  std::map<NodeId, Download> downloads_;
  std::map<NodeId, std::set<AgentId>> sources_;  ///< who has given chunks of a submap that is not whole
  std::map<std::pair<NodeId, AgentId>, Distrust> distrusted_;  ///< gave a submap with the wrong content
  std::optional<Stamp> paused_until_;                          ///< the store failed
  SubmapReceiverStats stats_;
};

struct SubmapSenderStats {
  std::uint64_t requests = 0;
  std::uint64_t refused = 0;  ///< requests for what is not held or does not exist
  std::uint64_t dropped = 0;  ///< chunks that did not fit the queue
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;  ///< payload sent
};

/// Serves held submaps to the agents that ask, in turns, at the rate of the link.
class SubmapSender {
 public:
  SubmapSender(const AgentId& self, const SubmapTransferConfig& config);

  /// Sent every digest_period, so that agents in reach notice each other.
  /// `hears`: the agents that this one hears on the link.
  std::optional<SubmapDigest> digest(const store::Store& store, std::vector<AgentId> hears, Stamp now);
  /// A peer came into reach: the next digest is sent at the next tick instead of after digest_period.
  void on_newcomer() { next_digest_.reset(); }
  void on_request(const SubmapRequest& request, const store::Store& store);
  /// Chunks that may go at `now`. Reads from `store`; a damaged submap is dropped by it.
  std::vector<SubmapChunk> tick(store::Store& store, Stamp now);

  bool idle() const { return queues_.empty(); }
  /// Agents that chunks wait for.
  std::size_t peers() const { return queues_.size(); }
  const SubmapSenderStats& stats() const { return stats_; }

 private:
  struct Piece {
    NodeId node;
    std::uint32_t chunk = 0;
    auto operator<=>(const Piece&) const = default;
  };
  struct Queue {
    std::deque<Piece> pieces;
    std::set<Piece> queued;
  };
  const Bytes* load(store::Store& store, const NodeId& id);

  AgentId self_;
  SubmapTransferConfig config_;
  TokenBucket bucket_;
  std::map<AgentId, Queue> queues_;
  AgentId last_served_;
  std::map<NodeId, Bytes> loaded_;  ///< the few submaps being sent
  std::optional<Stamp> next_digest_;
  std::size_t next_range_ = 0;
  SubmapSenderStats stats_;
};

}  // namespace fleetmap::exchange
