#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_client.hpp"
#include "fleetmap/exchange/exchange_config.hpp"
#include "fleetmap/exchange/exchange_events.hpp"
#include "fleetmap/store/store.hpp"
#include "item_verifier.hpp"
#include "membership.hpp"
#include "missing_submaps.hpp"
#include "outbox.hpp"
#include "own_items_check.hpp"
#include "reconcile.hpp"

namespace fleetmap::exchange {

using messages::Digest;
using messages::ItemRequest;
using messages::Reach;

/// Link and robot from which an item arrived; no robot where the link does not identify it.
struct Delivery {
  Reach link = Reach::kLongRange;
  std::optional<AgentId> from;
};

/// Exchange of nodes and alignments. Own items are signed, stored and sent to all. Items of others are
/// stored if a member made them, its signature proves it, and their number is not one of the running session
/// of this robot; Reconcile finds those that are missing.
class ItemExchange {
 public:
  /// The references outlive this. Reports the items in `store` to `cloud_client`.
  ItemExchange(const ExchangeConfig& config, store::Store& store, CloudClient& cloud_client,
               Membership& members, Outbox& outbox, std::vector<Event>& events, Stamp now);

  void begin_session(std::uint16_t session) { own_items_.begin_session(session); }
  Result<store::Put> add_own(const graph::Node& made, ByteView submap, Stamp now);
  Result<store::Put> add_own(const graph::Alignment& made, Stamp now);

  void receive(const graph::Node& node, const Delivery& delivery, Stamp now);
  void receive(const graph::Alignment& alignment, const Delivery& delivery, Stamp now);
  void on_digest(const Digest& digest, Stamp now);
  void on_request(const ItemRequest& request);
  /// The whole submap of the node is in the store.
  void on_submap(const NodeId& node);
  void tick(Stamp now);

  /// Every node, alignment and submap that a robot offers is held (Exchange::complete).
  bool complete(const NeighbourTable& neighbours, const std::set<AgentId>& without) const;
  Reconcile& reconcile() { return reconcile_; }
  const Reconcile& reconcile() const { return reconcile_; }
  const ItemVerifier& verifier() const { return verifier_; }

 private:
  struct Name {
    NodeId id;  ///< of the node, or (computed_by, seq) of the alignment
    bool alignment = false;
  };
  /// The item is held, or its signature is valid; else it is refused and reported.
  template <class Item>
  bool is_proven(const Item& item, const Name& name, const Delivery& delivery);
  /// The item has a number of the running session that this robot has not used.
  bool is_forged(const Name& name, const store::SeqSet& held) const;
  void on_put(const Result<store::Put>& put, const Event& added, const Name& name, const Delivery& delivery,
              Stamp now);
  void report_conflict(const Name& name, const Delivery& delivery);

  store::Store& store_;
  CloudClient& cloud_client_;
  Membership& members_;
  Outbox& outbox_;
  std::vector<Event>& events_;
  ItemVerifier verifier_;
  OwnItemsCheck own_items_;
  Reconcile reconcile_;
  MissingSubmaps missing_submaps_;
};

}  // namespace fleetmap::exchange
