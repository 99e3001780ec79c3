#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange_stats.hpp"
#include "fleetmap/exchange/long_range_config.hpp"
#include "fleetmap/exchange/pace.hpp"
#include "fleetmap/exchange/priority.hpp"
#include "fleetmap/messages/routing.hpp"

namespace fleetmap::exchange {

using messages::CloudFragment;
using messages::Message;
using messages::Outgoing;

/// Queue of the long-range link, which keeps to this robot's share of the fleet's budget.
///
/// Without multicast a message to all goes to one robot after the other, because nine copies at once exceed
/// what a robot of ten may send in a second.
class SendQueue {
 public:
  /// `peers`: the other robots of the fleet; `payload_size`: bytes of a message as the bus publishes it.
  SendQueue(const LongRangeConfig& config, std::span<const AgentId> peers,
            std::function<std::size_t(const Message&)> payload_size);

  /// This robot's share of the fleet's budget, B/s; initially the even share.
  void set_share(double bytes_per_second, Stamp now) { pace_.set_rate(bytes_per_second, now); }
  /// B on the wire that did not pass this queue but count against the share.
  void spend(std::size_t bytes, Stamp now) { pace_.spend(static_cast<double>(bytes), now); }
  /// Replaces a waiting message of the same kind and subject, in its position. `to` overrides the recipient
  /// that the message names (nodes and alignments name none). A message to all goes to all peers.
  void push(Priority priority, Message message, std::optional<AgentId> to = std::nullopt);
  /// The second content of a contested name, which does not replace the first one where that still waits.
  void push_second(Priority priority, Message message, const AgentId& to);
  /// Adds a piece of a cloud whose alignment adds `information` nats: clouds with the most information per
  /// byte go first.
  void push_fragment(CloudFragment fragment, float information);
  /// A message to these alone of all peers; one on a medium with multicast.
  void push_to(const std::set<AgentId>& receivers, Priority priority, Message message);
  /// Drops the fragments of the cloud of `node` for `to`; returns how many.
  std::size_t cancel_cloud(const AgentId& to, const NodeId& node);
  /// Removes and returns the messages addressed to one of `peers`, to be sent over another link.
  std::vector<Outgoing> take_for(const std::set<AgentId>& peers);
  /// Removes and returns the messages that may be sent at `now`.
  std::vector<Outgoing> take(Stamp now);

  bool empty() const { return index_.empty(); }
  std::size_t size(Priority priority) const { return waiting_[static_cast<std::size_t>(priority)].size(); }
  /// Wire bytes waiting.
  std::size_t backlog_bytes() const { return backlog_; }
  double share_bytes_per_second() const { return pace_.rate(); }
  double burst_bytes() const { return pace_.burst(); }
  /// Wire bytes of a message: overhead and every copy counted.
  std::size_t wire_bytes(const Message& message, const std::optional<AgentId>& to) const;
  const SendQueueStats& stats() const { return stats_; }

 private:
  /// Kind, recipient, subject, part: what makes two messages the same.
  using Key = std::tuple<std::size_t, AgentId, NodeId, std::uint32_t>;
  struct Item {
    Key key;
    Outgoing outgoing;
    std::size_t bytes = 0;           ///< of one datagram
    std::vector<AgentId> receivers;  ///< that still get a datagram of their own; empty: one datagram for all
    double rank = 0.0;               ///< of a fragment: nats per byte of its cloud
    bool second = false;             ///< the second content of its name
    std::size_t all_bytes() const { return bytes * std::max<std::size_t>(receivers.size(), 1); }
  };
  using Items = std::list<Item>;
  struct Position {
    std::size_t priority;
    Items::iterator item;
  };

  static Key key_of(const Outgoing& outgoing);
  void insert(Priority priority, Item item);
  /// Takes one datagram of the item, which is erased with its last one.
  Outgoing take_one(const Position& position);
  void erase(const Position& position);
  std::size_t capacity(std::size_t priority) const;
  std::optional<std::size_t> next() const;
  void note_sent(std::size_t priority, double bytes);

  LongRangeConfig config_;
  std::vector<AgentId> peers_;
  std::function<std::size_t(const Message&)> payload_size_;
  Pace pace_;
  std::array<Items, kPriorities> waiting_;
  std::map<Key, Position> index_;
  std::size_t backlog_ = 0;
  double items_lead_ = 0.0;         ///< B that news, state and backfill have had more than clouds that wait
  double small_lead_ = 0.0;         ///< B that news and state have had more than backfill that waits
  std::size_t first_receiver_ = 0;  ///< of the next message to all, by index, so that no robot is always last
  SendQueueStats stats_;
};

}  // namespace fleetmap::exchange
