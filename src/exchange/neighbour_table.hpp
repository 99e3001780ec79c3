#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/submap_transfer_config.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::SubmapDigest;

/// Neighbour table of the short-range link: which robots are within reach, in both directions or in one, and
/// which submaps each of them holds, by their digests.
class NeighbourTable {
 public:
  NeighbourTable(const AgentId& self, const SubmapTransferConfig& config) : self_(self), config_(config) {}

  /// Any short-range message of `name` arrived.
  void on_heard(const AgentId& name, Stamp now);
  void on_digest(const SubmapDigest& digest, Stamp now);

  bool in_reach(const AgentId& name, Stamp now) const;
  /// The robot is in reach, and its last digest named this robot as heard.
  bool hears_us(const AgentId& name, Stamp now) const;
  /// Most of its digests of the last peer_timeout arrived and named this robot: the link works both ways.
  bool is_near(const AgentId& name, Stamp now) const;
  /// The robot was heard, and its digests do not contain the submap.
  bool lacks(const AgentId& name, const NodeId& id) const;
  /// The same, by a digest that arrived after `since`.
  bool lacks_since(const AgentId& name, const NodeId& id, Stamp since) const;
  bool holds(const AgentId& name, const NodeId& id) const;
  std::vector<AgentId> in_reach(Stamp now) const;
  /// Robots in reach whose digests name exactly the submaps that `store` holds.
  std::vector<AgentId> in_sync_with(const store::Store& store, Stamp now) const;
  /// The submaps among `lacking` that a robot which hears this one offers, at most `max` of each robot.
  store::SeqSet offered(const store::SeqSet& lacking, std::uint64_t max, Stamp now) const;

  std::size_t size() const { return neighbours_.size(); }
  /// Ranges of digests that are reversed, beyond kEndOfSeqs or of several sessions.
  std::uint64_t hostile_ranges() const { return hostile_; }

 private:
  struct Neighbour {
    Stamp heard;
    bool hears_us = false;
    std::deque<Stamp> heard_by_it;  ///< digests of the last peer_timeout that named this robot
    store::SeqSet holds;            ///< by its last digests
    Stamp digest_received;
  };

  AgentId self_;
  SubmapTransferConfig config_;
  std::map<AgentId, Neighbour> neighbours_;
  std::uint64_t hostile_ = 0;
};

}  // namespace fleetmap::exchange
