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

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/pace.hpp"
#include "fleetmap/messages/routing.hpp"

namespace fleetmap::exchange {

using messages::CloudFragment;
using messages::Message;
using messages::Outgoing;
using messages::Reach;

/// What goes first. Safety and control go before all else. News and state, in this order, go before backfill,
/// and all three before clouds; but while clouds wait, they get more than half of what is left by safety and
/// control, and backfill gets half of the rest.
enum class Priority : std::uint8_t {
  kSafety,    ///< orders to stand still
  kControl,   ///< matches and requests: a few bytes that set others to work
  kNews,      ///< own new nodes and alignments
  kState,     ///< digests and status
  kBackfill,  ///< items that an agent asked for
  kCloud      ///< fragments of spherized clouds
};
inline constexpr std::size_t kPriorities = 6;

struct LongRangeConfig {
  /// B/s that all agents together send: 145 kbit/s in the mean, and 160 of the radio's 200 in any second.
  double fleet_bytes_per_second = 18'125;
  PaceConfig pace;
  double small_reserve_bytes = 300;  ///< B, left by backfill and clouds so that a small message goes at once
  std::size_t overhead_bytes =
      174;  ///< B a message, as captured: 14 of Ethernet, 28 of IP and UDP, 132 of RTPS
  bool deliver_to_one =
      true;                ///< a message with a recipient goes to it alone; false: every agent gets a copy
  bool multicast = false;  ///< a message to all is one on the medium; false: one for each other agent
  std::size_t max_small = 512;  ///< messages waiting in each of the classes safety, control, news and state
  std::size_t max_backfill = 512;   ///< messages
  std::size_t max_fragments = 512;  ///< messages
  Status validate() const;
  /// How often a message to all crosses the medium.
  std::size_t copies(std::size_t fleet_size) const {
    return multicast || fleet_size < 2 ? 1 : fleet_size - 1;
  }
};

struct SendQueueStats {
  std::array<std::uint64_t, kPriorities> sent{};     ///< messages
  std::array<std::uint64_t, kPriorities> dropped{};  ///< when the class was full
  std::uint64_t superseded = 0;                      ///< replaced by a newer message of the same key
  std::uint64_t cancelled = 0;                       ///< no longer worth their bytes
  std::uint64_t wire_bytes = 0;                      ///< sent, with overhead, times receivers
};

/// Queue of the long-range link, which keeps to this robot's share of the fleet's budget.
///
/// Where the medium has no multicast, a message to all goes to one robot after the other: nine copies at once
/// would be more than a second's worth of a robot of ten.
class SendQueue {
 public:
  /// `peers`: the other robots of the fleet; `payload_size`: bytes of a message as the bus publishes it.
  SendQueue(const LongRangeConfig& config, std::span<const AgentId> peers,
            std::function<std::size_t(const Message&)> payload_size);

  /// Of the fleet's budget, B/s; at first the even part.
  void set_share(double bytes_per_second, Stamp now) { pace_.set_rate(bytes_per_second, now); }
  /// B on the wire that did not pass this queue but count against the share.
  void spend(std::size_t bytes, Stamp now) { pace_.spend(static_cast<double>(bytes), now); }
  /// A message of the same kind about the same thing that still waits is replaced and keeps its place. `to`
  /// overrides the recipient that the message names (for nodes and alignments, which name none). One to all
  /// goes to all peers.
  void push(Priority priority, Message message, std::optional<AgentId> to = std::nullopt);
  /// The second content of a contested name, which does not replace the first one where that still waits.
  void push_second(Priority priority, Message message, const AgentId& to);
  /// A piece of a cloud whose receiver hopes to learn `worth` nats: clouds that are worth most per byte go
  /// first.
  void push_fragment(CloudFragment fragment, float worth);
  /// A message to these alone of all peers; one on a medium with multicast.
  void push_to(const std::set<AgentId>& receivers, Priority priority, Message message);
  /// Drops the fragments of the cloud of `node` for `to`; returns how many.
  std::size_t cancel_cloud(const AgentId& to, const NodeId& node);
  /// Removes and returns the messages addressed to one of `peers`, to be sent over another link.
  std::vector<Outgoing> take_for(const std::set<AgentId>& peers);
  /// What may go at `now`.
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
    std::vector<AgentId> receivers;  ///< who still get a datagram of their own; nobody: it goes once
    double rank = 0.0;               ///< of a fragment: nats per byte of its cloud
    bool second = false;             ///< the second content of its name
    std::size_t all_bytes() const { return bytes * std::max<std::size_t>(receivers.size(), 1); }
  };
  using Items = std::list<Item>;
  struct Place {
    std::size_t priority;
    Items::iterator item;
  };

  static Key key_of(const Outgoing& outgoing);
  void insert(Priority priority, Item item);
  /// One datagram of the item, which is erased with its last.
  Outgoing take_one(const Place& place);
  void erase(const Place& place);
  std::size_t capacity(std::size_t priority) const;
  std::optional<std::size_t> next() const;
  void note_sent(std::size_t priority, double bytes);

  LongRangeConfig config_;
  std::vector<AgentId> peers_;
  std::function<std::size_t(const Message&)> payload_size_;
  Pace pace_;
  std::array<Items, kPriorities> waiting_;
  std::map<Key, Place> index_;
  std::size_t backlog_ = 0;
  double items_lead_ = 0.0;         ///< B that news, state and backfill have had more than clouds that wait
  double small_lead_ = 0.0;         ///< B that news and state have had more than backfill that waits
  std::size_t first_receiver_ = 0;  ///< of the next message to all, by index: nobody is always the last
  SendQueueStats stats_;
};

}  // namespace fleetmap::exchange
