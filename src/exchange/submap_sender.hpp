#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange_stats.hpp"
#include "fleetmap/exchange/submap_transfer_config.hpp"
#include "fleetmap/exchange/token_bucket.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::SubmapChunk;
using messages::SubmapDigest;
using messages::SubmapRequest;

/// Sends held submaps to the robots that request them, in turns, at the rate of the link.
class SubmapSender {
 public:
  SubmapSender(const AgentId& self, const SubmapTransferConfig& config);

  /// Sent every digest_period, so that agents in reach notice each other.
  /// `hears`: the agents that this one hears on the link.
  std::optional<SubmapDigest> digest(const store::Store& store, std::vector<AgentId> hears, Stamp now);
  /// A peer has come into reach: the next digest is sent at the next tick instead of after digest_period.
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
