#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "content_check.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange_stats.hpp"
#include "fleetmap/exchange/reconcile_config.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::Digest;
using messages::ItemRequest;

/// Makes the sets of nodes and alignments of all robots equal (anti-entropy): robots periodically send
/// digests of their sets, and a robot requests missing items from any one that holds them, maker or not.
///
/// An offer is a claim. The latest digest replaces what earlier ones said of the names that it covers, so a
/// forged or outdated one lasts until the robot's own have gone round; items that a robot offers but does not
/// deliver are no longer waited for. ContentCheck finds names under which two robots hold different contents.
class Reconcile {
 public:
  Reconcile(const AgentId& self, const ReconcileConfig& config);

  /// No digest before.
  void begin_at(Stamp first_digest) { next_digest_ = first_digest; }
  void on_digest(const Digest& digest, const store::Store& store, Stamp now);
  void on_heard(const AgentId& peer, Stamp now);
  /// A node or alignment was added to the store.
  void on_item(Stamp now);

  struct Items {
    std::vector<const graph::Node*> nodes;
    std::vector<const graph::Alignment*> alignments;
    /// The second contents of contested names whose first are in the lists above.
    std::vector<const graph::Node*> second_nodes;
    std::vector<const graph::Alignment*> second_alignments;
  };
  /// The held items that `request` names, at most max_items.
  Items answer(const ItemRequest& request, const store::Store& store);

  /// Items that `peer` offers but does not deliver; reported once, until it delivers again.
  struct UndeliveredOffer {
    AgentId peer;
    std::uint64_t nodes = 0;
    std::uint64_t alignments = 0;
  };
  struct Due {
    std::optional<Digest> digest;
    std::vector<ItemRequest> requests;
    std::vector<UndeliveredOffer> undelivered;
  };
  Due tick(const store::Store& store, Stamp now);

  /// For those in reach on the short range: of what is held, as many ranges as fit; the others next time.
  Digest near_digest(const store::Store& store) { return digest_of(store, next_near_part_); }
  /// A received item could not be stored. Requests pause, since the answers could not be stored either.
  void on_store_failure(Stamp now);
  /// A name was found to have two contents.
  void on_contested(Stamp now);
  /// Every item that any robot offers, except those in `without`, is held or was not delivered.
  bool complete(const store::Store& store, const std::set<AgentId>& without = {}) const;
  /// By its digest `peer` holds everything that this robot holds.
  bool caught_up(const AgentId& peer, const store::Store& store) const;
  std::size_t peers() const { return peers_.size(); }
  const ReconcileStats& stats() const { return stats_; }

 private:
  struct Offer {
    store::SeqSet nodes;
    store::SeqSet alignments;
    store::SeqSet undelivered_nodes;  ///< of these, not delivered
    store::SeqSet undelivered_alignments;
    Stamp since;           ///< when it was first seen to have what we lack
    bool lacking = false;  ///< it has what we lack
  };
  struct Pending {
    store::SeqSet nodes;
    store::SeqSet alignments;
    std::uint64_t left = 0;
    Stamp deadline;
  };
  struct Peer {
    Offer offer;
    std::optional<Pending> pending;
    Stamp heard;
    Stamp resting_until;  ///< after a request that brought nothing
    Duration rest = Duration::zero();
    int barren = 0;                     ///< requests in a row that brought nothing
    bool undelivered_reported = false;  ///< of the offer
  };
  /// Indices of the ranges that the next digest begins with when not all fit.
  struct NextPart {
    std::size_t nodes = 0;
    std::size_t alignments = 0;
  };
  /// The requested ranges that are in order.
  store::SeqSet requested(const std::vector<SeqRange>& ranges);
  void update_undelivered(const AgentId& name, Peer& peer, const store::Store& store, Due& due);
  void update_pending(Peer& peer, const store::Store& store, Stamp now);
  /// Sends the next digest after the shortest period.
  void hurry(Stamp now);
  Digest digest_of(const store::Store& store, NextPart& next) const;
  std::optional<ItemRequest> ask(const AgentId& name, Peer& peer, const store::Store& store, Stamp now);

  AgentId self_;
  ReconcileConfig config_;
  std::map<AgentId, Peer> peers_;
  ContentCheck check_;
  Duration period_;
  std::optional<Stamp> next_digest_;
  std::optional<Stamp> last_digest_;
  NextPart next_part_;
  NextPart next_near_part_;  ///< over the short range
  Duration store_pause_ = Duration::zero();
  std::optional<Stamp> paused_until_;
  ReconcileStats stats_;
};

}  // namespace fleetmap::exchange
