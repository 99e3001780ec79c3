#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/item_proof.hpp"
#include "fleetmap/exchange/priority.hpp"

namespace fleetmap::exchange {

/// Counters of the long-range queue.
struct SendQueueStats {
  std::array<std::uint64_t, kPriorities> sent{};     ///< messages
  std::array<std::uint64_t, kPriorities> dropped{};  ///< when the class was full
  std::uint64_t superseded = 0;                      ///< replaced by a newer message of the same key
  std::uint64_t cancelled = 0;                       ///< not sent because no longer needed
  std::uint64_t wire_bytes = 0;                      ///< sent, with overhead, times receivers
};

/// Counters of spherized clouds that this robot sends.
struct CloudSenderStats {
  std::uint64_t offered = 0;       ///< clouds
  std::uint64_t too_large = 0;     ///< clouds refused
  std::uint64_t bad_requests = 0;  ///< requested pieces that do not exist
};

/// Counters of spherized clouds that this robot receives.
struct CloudReceiverStats {
  std::uint64_t received = 0;  ///< whole clouds with the right hash
  std::uint64_t abandoned = 0;
  std::uint64_t bad_hash = 0;    ///< whole clouds with the wrong hash
  std::uint64_t duplicates = 0;  ///< fragments held already
  std::uint64_t unasked = 0;     ///< fragments of clouds that were not requested
  std::uint64_t hostile = 0;     ///< fragments whose numbers contradict themselves, the rules or each other
  std::uint64_t requests = 0;
};

/// Counters of the reconciliation of items by digests.
struct ReconcileStats {
  std::uint64_t digests_sent = 0;
  std::uint64_t digests_heard = 0;
  std::uint64_t requests_sent = 0;
  std::uint64_t requests_served = 0;
  std::uint64_t items_served = 0;
  std::uint64_t timeouts = 0;
  std::uint64_t hostile = 0;  ///< ranges that are reversed, beyond kEndOfSeqs or of several sessions
};

/// Counters of submaps that this robot fetches over the short range.
struct SubmapReceiverStats {
  std::uint64_t requests = 0;
  std::uint64_t chunks = 0;      ///< that brought something new
  std::uint64_t duplicates = 0;  ///< held already
  std::uint64_t timeouts = 0;    ///< chunks requested again
  std::uint64_t hostile = 0;     ///< chunks and ranges that contradict the node or the rules
  std::uint64_t unasked = 0;     ///< chunks that were not requested, or from another peer
  std::uint64_t bad_hash = 0;    ///< whole submaps with the wrong content
  std::uint64_t submaps = 0;     ///< completed
};

/// Counters of submaps that this robot sends over the short range.
struct SubmapSenderStats {
  std::uint64_t requests = 0;
  std::uint64_t refused = 0;  ///< requests for what is not held or does not exist
  std::uint64_t dropped = 0;  ///< chunks that did not fit the queue
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;  ///< payload sent
};

/// Counters of the transport of one robot since its start.
struct ExchangeStats {
  SendQueueStats long_range;
  CloudSenderStats cloud_sender;
  CloudReceiverStats cloud_receiver;
  ReconcileStats reconcile;
  SubmapReceiverStats submap_receiver;
  SubmapSenderStats submap_sender;
  std::uint64_t strangers = 0;     ///< messages and items of agents that are not of the fleet, and own echoes
  std::uint64_t bad_requests = 0;  ///< for clouds of nodes that are not ours
  /// Verified items by result; all but the genuine ones were refused.
  std::array<std::uint64_t, kItemProofs> proofs{};
  /// Messages that contradict the rules or bear another robot's name, by sender.
  std::map<AgentId, std::uint64_t> misbehaved;
};

/// Entries of the tables that what others send can fill.
struct TableSizes {
  std::size_t item_peers = 0;
  std::size_t submap_peers = 0;
  std::size_t submap_requesters = 0;
  std::size_t submap_downloads = 0;
  std::size_t clouds_to_make = 0;
  std::size_t strangers = 0;
  std::size_t refusals = 0;
};

}  // namespace fleetmap::exchange
