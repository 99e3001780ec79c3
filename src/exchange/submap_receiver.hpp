#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "delay_window.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange_stats.hpp"
#include "fleetmap/exchange/submap_transfer_config.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"
#include "neighbour_table.hpp"

namespace fleetmap::exchange {

using messages::SubmapChunk;
using messages::SubmapDigest;
using messages::SubmapRequest;

/// Fetches the submaps that this robot lacks from robots in reach that hold them, maker or not. Limits the
/// bytes under way by one congestion window for each peer, since each may be behind another path, and one
/// for all of them, since they mostly share a channel. Never requests a chunk from two peers at the same
/// time, and resumes interrupted downloads.
class SubmapReceiver {
 public:
  SubmapReceiver(const AgentId& self, const SubmapTransferConfig& config);

  void on_digest(const SubmapDigest& digest, Stamp now);
  /// Any short-range message of `peer` arrived.
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

  const NeighbourTable& neighbours() const { return neighbours_; }
  /// Peers that chunks are under way from.
  std::vector<AgentId> asked() const;
  /// Nothing is under way, and no peer in reach has what we lack.
  bool idle(const store::Store& store, Stamp now) const;
  std::size_t peers() const { return peers_.size(); }
  std::size_t downloads() const { return downloads_.size(); }
  SubmapReceiverStats stats() const;

 private:
  struct Flight {
    std::uint32_t bytes = 0;
    std::uint64_t order = 0;  ///< number of the request among all chunks requested from the peer
    Stamp sent;
    Stamp deadline;
  };
  struct Peer {
    explicit Peer(const DelayWindowConfig& config) : window(config) {}
    bool has_room(std::uint32_t bytes) const { return bytes_out + bytes <= window.bytes(); }
    DelayWindow window;
    BaseDelay base_delay;
    std::uint64_t bytes_out = 0;  ///< requested and not yet received
    double delay = 0.0;           ///< s, smoothed, from request to chunk
    double spread = 0.0;          ///< s, its smoothed deviation
    Stamp last_chunk;
    std::uint64_t asked = 0;     ///< chunks
    std::uint64_t answered = 0;  ///< the latest requested chunk among the received ones
  };
  struct Download {
    AgentId peer;  ///< one submap comes from one peer at a time, so that wrong content is attributed to its
                   ///< source
    Stamp last_arrival;                       ///< or when it was begun
    std::map<std::uint32_t, Flight> flights;  ///< by chunk
    std::set<std::uint32_t> asked;            ///< chunks requested, including lost ones
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
  bool may_serve(const AgentId& name, const NodeId& id, Stamp now) const;
  static std::uint32_t chunk_bytes(const graph::Node& node, std::uint32_t chunk);

  AgentId self_;
  SubmapTransferConfig config_;
  NeighbourTable neighbours_;
  DelayWindow window_;           ///< of all peers together
  std::uint64_t bytes_out_ = 0;  ///< of all peers together
  std::map<AgentId, Peer> peers_;
  std::map<NodeId, Download> downloads_;
  std::map<NodeId, std::set<AgentId>> sources_;  ///< peers that sent chunks of an incomplete submap
  std::map<std::pair<NodeId, AgentId>, Distrust> distrusted_;  ///< gave a submap with the wrong content
  std::optional<Stamp> paused_until_;                          ///< the store failed
  SubmapReceiverStats stats_;
};

}  // namespace fleetmap::exchange
