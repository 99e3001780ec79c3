#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "budget_shares.hpp"
#include "cloud_exchange.hpp"
#include "fleetmap/exchange/exchange.hpp"
#include "fleetmap/orders/hold_orders.hpp"
#include "item_exchange.hpp"
#include "membership.hpp"
#include "misbehaviour.hpp"
#include "outbox.hpp"
#include "submap_receiver.hpp"
#include "submap_sender.hpp"

namespace fleetmap::exchange {

using messages::AgentStatus;
using messages::CloudFragment;
using messages::CloudRequest;
using messages::Digest;
using messages::Hold;
using messages::HoldOrder;
using messages::ItemRequest;
using messages::Message;
using messages::MissionReport;
using messages::Outgoing;
using messages::ProximityMatch;
using messages::Reach;
using messages::SubmapChunk;
using messages::SubmapDigest;
using messages::SubmapRequest;
using orders::HoldOrders;

/// The parts of an Exchange, the messages that each of them handles, and their order in a tick.
struct Exchange::State {
  /// Key of the orders in the store.
  static constexpr const char* kHoldKey = "hold_orders";

  State(const ExchangeConfig& config, store::Store& store, CloudClient& cloud_client, Stamp now);
  State(const State&) = delete;  // the parts refer to each other
  State& operator=(const State&) = delete;

  void on_message(const Message& message, const Delivery& delivery, Stamp now);
  std::vector<Outgoing> tick(Stamp now);
  bool complete(const std::set<AgentId>& without) const;
  bool idle(Stamp now, const std::set<AgentId>& without) const;
  /// Emits HoldChanged if `before` is no longer in force. The robot obeys before the order is stored.
  void note_orders(const std::optional<HoldOrder>& before);
  void note_row_orders();
  /// With the counts of the store and the queue, without stamp.
  AgentStatus own_status() const;
  Hold::Driving own_driving() const;

  ExchangeConfig config;
  store::Store& store;
  CloudClient& cloud_client;
  std::vector<Event> events;
  Membership members;
  Misbehaviour misbehaviour;
  BudgetShares shares;
  Outbox outbox;
  CloudExchange clouds;
  ItemExchange items;
  SubmapReceiver submap_receiver;
  SubmapSender submap_sender;
  HoldOrders holds;
  AgentStatus status;
  std::optional<Stamp> next_status;
  bool drives = false;
  bool orders_to_store = false;  ///< orders have changed since they were stored
  std::map<AgentId, Stamp> busy_until;
  std::map<AgentId, AgentStatus> heard_statuses;   ///< the last of each other robot
  std::map<AgentId, Hold::Driving> heard_driving;  ///< likewise
  std::uint64_t sent_before_status = 0;            ///< wire bytes
  std::set<AgentId> in_reach;                      ///< of the short range, in the tick before
  std::optional<Stamp> next_near_digest;
  bool was_complete = false;

 private:
  /// The message is of a member, or an operator's order, and for this robot or for all.
  bool admit(const Message& message, Reach link, Stamp now);
  /// Messages that the handlers refused so far, by SenderMisbehaved::Kind.
  std::array<std::uint64_t, kMisbehaviourKinds> refused() const;
  void report_misbehaviour(const AgentId& name, const Delivery& delivery, SenderMisbehaved::Kind kind);

  void handle(const graph::Node& node, const Delivery& delivery, Stamp now);
  void handle(const graph::Alignment& alignment, const Delivery& delivery, Stamp now);
  void handle(const ProximityMatch& match, const Delivery& delivery, Stamp now);
  void handle(const CloudFragment& fragment, const Delivery& delivery, Stamp now);
  void handle(const CloudRequest& request, const Delivery& delivery, Stamp now);
  void handle(const Digest& digest, const Delivery& delivery, Stamp now);
  void handle(const ItemRequest& request, const Delivery& delivery, Stamp now);
  void handle(const AgentStatus& status, const Delivery& delivery, Stamp now);
  void handle(const MissionReport& report, const Delivery& delivery, Stamp now);
  void handle(const Hold& hold, const Delivery& delivery, Stamp now);
  void handle(const SubmapDigest& digest, const Delivery& delivery, Stamp now);
  void handle(const SubmapRequest& request, const Delivery& delivery, Stamp now);
  void handle(const SubmapChunk& chunk, const Delivery& delivery, Stamp now);
  void add_submap(const NodeId& node);

  void tick_receivers(Stamp now);
  void tick_holds(Stamp now);
  void tick_status(Stamp now);
  void tick_short_range(std::vector<Outgoing>& out, Stamp now);
  /// Syncs the store before digests are sent, since others rely on what they name. Digests are dropped if
  /// that fails.
  void sync_before_digests(std::vector<Outgoing>& out);
  void note_completion();
};

}  // namespace fleetmap::exchange
