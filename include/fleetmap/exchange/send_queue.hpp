#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/routing.hpp"
#include "fleetmap/exchange/token_bucket.hpp"

namespace fleetmap::exchange {

/// What goes first. The first four go in this order; backfill and clouds share what they leave.
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
  /// B/s that all agents together send: 145 kbit/s. Since a burst of each robot may fall into the same
  /// second, the wire then carries less than 160 of the radio's 200 kbit/s in any second (docs/dds.md).
  double fleet_bytes_per_second = 18'125;
  double burst_seconds = 0.2;        ///< s, a share's worth of bytes that may go at once after silence
  double min_burst_bytes = 1400;     ///< B, at least one full fragment with its headers
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
  std::array<std::uint64_t, kPriorities> dropped{};  ///< the oldest, when the class was full
  std::uint64_t superseded = 0;                      ///< replaced by a newer message of the same key
  std::uint64_t cancelled = 0;                       ///< no longer worth their bytes
  std::uint64_t wire_bytes = 0;                      ///< sent, with overhead, times receivers
};

/// Queue of the long-range link. Every agent has a fixed share of the fleet's budget, so the sum over the
/// fleet stays within it without any talk: in T seconds at most budget * T + the sum of the bursts.
class SendQueue {
 public:
  /// `payload_size`: bytes of a message as the bus publishes it.
  SendQueue(const LongRangeConfig& config, std::size_t fleet_size,
            std::function<std::size_t(const Message&)> payload_size);

  /// A message of the same kind about the same thing that still waits is replaced and keeps its place. `to`
  /// overrides the recipient that the message names (for nodes and alignments, which name none).
  void push(Priority priority, Message message, std::optional<AgentId> to = std::nullopt);
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
  double share_bytes_per_second() const { return share_; }
  double burst_bytes() const { return bucket_.burst(); }
  /// Wire bytes of a message: overhead and every copy counted.
  std::size_t wire_bytes(const Message& message, const std::optional<AgentId>& to) const;
  const SendQueueStats& stats() const { return stats_; }

 private:
  /// Kind, recipient, subject, part: what makes two messages the same.
  using Key = std::tuple<std::size_t, AgentId, NodeId, std::uint32_t>;
  struct Item {
    Key key;
    Outgoing outgoing;
    std::size_t bytes = 0;
  };
  using Items = std::list<Item>;
  struct Place {
    std::size_t priority;
    Items::iterator item;
  };

  static Key key_of(const Outgoing& outgoing);
  void erase(const Place& place);
  std::size_t capacity(std::size_t priority) const;
  std::optional<std::size_t> next() const;

  LongRangeConfig config_;
  std::size_t copies_;  ///< of a message to all
  std::function<std::size_t(const Message&)> payload_size_;
  double share_;
  TokenBucket bucket_;
  std::array<Items, kPriorities> waiting_;
  std::map<Key, Place> index_;
  std::size_t backlog_ = 0;
  double cloud_lead_ = 0.0;  ///< bytes that clouds have had more than backfill while both waited
  SendQueueStats stats_;
};

}  // namespace fleetmap::exchange
