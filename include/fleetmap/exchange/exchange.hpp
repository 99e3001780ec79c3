#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <variant>
#include <vector>

#include "fleetmap/exchange/budget_shares.hpp"
#include "fleetmap/exchange/cloud_transfer.hpp"
#include "fleetmap/exchange/hold_orders.hpp"
#include "fleetmap/exchange/item_proof.hpp"
#include "fleetmap/exchange/loop_closer.hpp"
#include "fleetmap/exchange/reconcile.hpp"
#include "fleetmap/exchange/send_queue.hpp"
#include "fleetmap/exchange/submap_transfer.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/messages/routing.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::AgentStatus;
using messages::Hold;
using messages::HoldOrder;
using messages::MissionReport;
using messages::ProximityMatch;

struct ExchangeConfig {
  std::vector<AgentId> fleet;  ///< every agent, this one too; messages and items of others are refused
  /// Of these, this one too, those on the same radio, who share its budget; the others are on radios of their
  /// own and heard over the short range alone. None: all.
  std::vector<AgentId> on_radio;
  LongRangeConfig long_range;
  CloudTransferConfig clouds;
  ReconcileConfig reconcile;
  SubmapTransferConfig submaps;
  Duration status_period = std::chrono::seconds(5);
  /// Bytes of a message as the bus publishes it (CDR with its encapsulation header).
  std::function<std::size_t(const Message&)> payload_size;
  /// Own items are signed, and those of others accepted only with the signature of their maker. None: items
  /// bear no signatures, and anyone may make them in any name.
  std::shared_ptr<const ItemAuthenticator> authenticator;
  Status validate(const AgentId& self) const;
  const std::vector<AgentId>& all_on_radio() const { return on_radio.empty() ? fleet : on_radio; }
};

/// The periods as they are for so many robots on this radio and budget, and `on_radio` filled in. A status or
/// digest goes to every other robot, so what is fixed grows with the square of their number, and clouds get
/// what it leaves. Where it would take more than it does of five robots on 145 kbit/s, it comes less often,
/// and a silent robot is asked for longer.
ExchangeConfig for_fleet(ExchangeConfig config);
/// `period` as for_fleet() stretches those of the exchange: no shorter than it is.
Duration for_fleet(Duration period, const ExchangeConfig& config);

// ---- what the agent hears
// ------------------------------------------------------------------------------------------

/// A node of another agent (or an own one, given back by others after our store was lost) is in the store.
struct NodeAdded {
  NodeId id;
};
struct AlignmentAdded {
  store::AlignmentId id;
};
/// The whole submap of a node is in the store.
struct SubmapAdded {
  NodeId id;
};
/// `to` wants the spherized cloud around our node: answer with provide_cloud() or decline_cloud().
struct CloudNeeded {
  NodeId node;
  AgentId to;
};
struct PeerStatus {
  AgentStatus status;
};
struct MissionHeard {
  MissionReport report;
};
/// Another order of an operator is in force for this agent.
struct HoldChanged {
  HoldOrder order;
};
/// An item with a taken name and another content came: a session number drawn twice, a forged item, or
/// damage. Where items are signed, the maker signed both: somebody else has its key, as on a copied disk, or
/// it equivocates. The name is contested from now on and has no item; of the running session's names that
/// this agent has not given, the item was refused. Own items are told again with reissue_contested().
struct ItemConflict {
  NodeId id;  ///< of the node, or (computed_by, seq) of the alignment
  bool alignment = false;
  Reach link = Reach::kLongRange;  ///< it came over
  bool signed_twice = false;       ///< by its maker
  std::optional<AgentId> from;     ///< who handed it over, where the link tells
};
/// An item was refused, since its signature does not prove that the robot whose name it bears made it. Told
/// once of each maker, reason and robot that hands such items over. The genuine item is accepted when it
/// comes.
struct ItemRefused {
  NodeId id;  ///< of the node, or (computed_by, seq) of the alignment
  bool alignment = false;
  ItemProof proof = ItemProof::kUnsigned;
  Reach link = Reach::kLongRange;  ///< it came over
  std::optional<AgentId> from;     ///< who handed it over, where the link tells
};
/// The store was of a time without keys, or of other keys.
struct ItemsAdopted {
  AdoptedItems items;
};
/// `peer` offers what it does not deliver: completion does not wait for it any more. It counts again once it
/// comes.
struct OfferDoubted {
  AgentId peer;
  std::uint64_t nodes = 0;
  std::uint64_t alignments = 0;
};
/// `peer` holds items of this agent that are not in our store: it was lost, restored or replaced. Told once.
struct OwnItemsElsewhere {
  AgentId peer;
  std::uint64_t nodes = 0;
  std::uint64_t alignments = 0;
};
/// `peer` holds items of the running session that this agent has not made: its number was drawn before.
struct SessionTaken {
  AgentId peer;
};
/// A robot that is not of the fleet was heard. Told once of each.
struct StrangerHeard {
  AgentId name;
};
/// The store's file failed; nothing that failed was accepted.
struct StoreFailed {
  Error error;
};
/// Everything known of is held. Comes again when more became known and was completed.
struct MapComplete {
  std::size_t nodes = 0;
  std::size_t alignments = 0;
};
using Event = std::variant<NodeAdded, AlignmentAdded, SubmapAdded, CloudNeeded, PeerStatus, MissionHeard,
                           HoldChanged, ItemConflict, ItemRefused, ItemsAdopted, OfferDoubted,
                           OwnItemsElsewhere, SessionTaken, StrangerHeard, StoreFailed, MapComplete>;

struct ExchangeStats {
  SendQueueStats long_range;
  CloudSenderStats cloud_sender;
  CloudReceiverStats cloud_receiver;
  ReconcileStats reconcile;
  SubmapReceiverStats submap_receiver;
  SubmapSenderStats submap_sender;
  std::uint64_t strangers = 0;     ///< messages and items of agents that are not of the fleet, and own echoes
  std::uint64_t bad_requests = 0;  ///< for clouds of nodes that are not ours
  /// Items that were verified, by what came out; all but the genuine ones were refused.
  std::array<std::uint64_t, kItemProofs> proofs{};
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

/// All that one agent says to the others and hears from them, as a state machine: messages and time in,
/// messages and events out. A message for one agent is sent over the short range if each of the two hears
/// the other there (near_), else over the radio. Call tick() at 10 Hz or more (50 Hz while submaps flow),
/// then take_events().
class Exchange {
 public:
  /// `store` and `loop_closer` outlive this. Begins from what the store holds; unfinished loop candidates are
  /// found again.
  static Result<Exchange> make(const ExchangeConfig& config, store::Store& store, LoopCloser& loop_closer,
                               Stamp now);

  /// Sets the running session. Items of this agent that bear its number and are not in the store are refused
  /// from now on (ItemConflict).
  void begin_session(std::uint16_t session) { session_ = session; }
  /// An own node with its encoded submap: stored, then told to all. The node must be what the wire makes of
  /// it (decode(encode(node))), so that all agents hold equal items. kConflict: the name is taken.
  Result<store::Put> on_own_node(const graph::Node& node, ByteView submap, Stamp now);
  /// An accepted registration of ours; the same rule as for nodes.
  Result<store::Put> on_own_alignment(const graph::Alignment& alignment, Stamp now);
  /// Answers CloudNeeded. Fails when the cloud is larger than the budget.
  Status provide_cloud(const NodeId& node, Bytes cloud, Stamp now);
  void decline_cloud(const NodeId& node);
  /// What the next status messages say of position, heading and battery, and whether more nodes will come;
  /// the rest is filled in.
  void set_status(const AgentStatus& status) { status_ = status; }
  /// Tells all what we do of the mission; a report that still waits is replaced.
  void tell(MissionReport report);
  /// Whether this agent drives a mission, which its answers to operators say. By default it does not.
  void set_drives(bool drives) { drives_ = drives; }
  /// An order that was given to this agent on its own robot: sent to all. One without a stamp (zero) gets one
  /// that replaces all others.
  void on_local_order(HoldOrder order, Stamp now);
  /// The order in force for this agent; nothing if there never was one. It survives a restart.
  std::optional<HoldOrder> hold_in_force() const { return holds_.in_force(); }

  /// `message` came over `link`, from a robot that the link may tell. Of items this is who hands them over.
  void on_message(const Message& message, Reach link, Stamp now, std::optional<AgentId> from = std::nullopt);
  void on_message(const Message& message, Stamp now) { on_message(message, usual_reach(message), now); }
  /// The long range itself has sent `bytes` on the wire, to find other robots: they count against the share.
  void on_discovery(std::size_t bytes, Stamp now) { queue_.spend(bytes, now); }
  std::vector<Outgoing> tick(Stamp now);
  std::vector<Event> take_events();

  /// Every node, alignment and submap that any agent offers is held. Not waited for is what an agent offers
  /// but does not deliver, a submap that every other agent has denied to hold, and, of the agents in
  /// `without`, which are lost, what nobody else has.
  bool complete(const std::set<AgentId>& without = {}) const;
  /// Every other agent of the fleet, but for those in `without`, has told that it holds the nodes and
  /// alignments that we hold.
  bool fleet_caught_up(const std::set<AgentId>& without = {}) const;
  /// Nothing waits to be sent, fetched or registered; what is wanted of the agents in `without` does not
  /// count.
  bool idle(Stamp now, const std::set<AgentId>& without = {}) const;
  /// A robot that is still heard has told that more nodes or alignments of it may come.
  bool others_busy(Stamp now) const;
  ExchangeStats stats() const;
  TableSizes table_sizes() const;
  const SendQueue& queue() const { return queue_; }
  /// Agents whose short-range link was heard of late.
  std::vector<AgentId> peers_in_reach(Stamp now) const { return submap_receiver_.peers_in_reach(now); }
  /// Whom submaps are fetched from at this moment.
  std::vector<AgentId> asked_for_submaps() const { return submap_receiver_.asked(); }
  /// Of these, those with whom nothing is left to be exchanged: both hold the same submaps.
  std::vector<AgentId> even_with(Stamp now) const { return submap_receiver_.even_with(*store_, now); }

 private:
  Exchange(const ExchangeConfig& config, store::Store& store, LoopCloser& loop_closer, Stamp now);
  bool member(const AgentId& agent) const { return fleet_.contains(agent); }
  bool admit(const Message& message, Reach link, Stamp now);
  void note_stranger(const AgentId& name);
  /// Of the item that is handled.
  void tell_conflict(const NodeId& name, bool alignment);
  /// The item bears a number that only this agent gives, and has not given.
  bool is_forged(const AgentId& maker, std::uint32_t seq, bool held) const;
  /// The item is held, or its maker signed it; else it is counted and told of.
  template <class Item>
  bool is_proven(const Item& item, const NodeId& name, bool alignment);
  void note_own_items(const Digest& digest);
  void on_put(const Result<store::Put>& put, const Event& added, const NodeId& id, bool alignment, Stamp now);
  /// Of the ranges, those whose agents are of the fleet; counts the others.
  std::vector<SeqRange> of_fleet(const std::vector<SeqRange>& ranges);
  /// All others were heard, and none holds it.
  bool nowhere(const NodeId& submap, const std::set<AgentId>& without) const;

  void handle(const graph::Node& node, Stamp now);
  void handle(const graph::Alignment& alignment, Stamp now);
  void handle(const ProximityMatch& match, Stamp now);
  void handle(const CloudFragment& fragment, Stamp now);
  void handle(const CloudRequest& request, Stamp now);
  void handle(const Digest& digest, Stamp now);
  void handle(const ItemRequest& request, Stamp now);
  void handle(const AgentStatus& status, Stamp now);
  void handle(const MissionReport& report, Stamp now);
  void handle(const Hold& hold, Stamp now);
  void handle(const SubmapDigest& digest, Stamp now);
  void handle(const SubmapRequest& request, Stamp now);
  void handle(const SubmapChunk& chunk, Stamp now);

  void send_fragments(std::vector<CloudFragment> fragments, float worth);
  /// Over the short range to those in reach, and over the radio to the others; orders over both to all.
  void tell_all(Priority priority, Message message);
  void note_near(Stamp now);
  void tick_loop_closing(Stamp now);
  void tick_clouds(Stamp now);
  void tick_items(Stamp now);
  void tick_status(Stamp now);
  void tick_holds(Stamp now);
  /// Emits HoldChanged if `before` is in force no more. The robot obeys before the disk is written to.
  void note_orders(const std::optional<HoldOrder>& before);
  void tick_short_range(std::vector<Outgoing>& out, Stamp now);
  /// Syncs the store before digests go out, since others rely on what they name; without that they stay here.
  void keep_what_is_told(std::vector<Outgoing>& out);
  void note_completion();

  struct Needed {
    std::map<AgentId, float> by;  ///< with the worth of each request
    Stamp told;                   ///< when the agent last heard of it
  };

  ExchangeConfig config_;
  store::Store* store_;
  AgentId self_;
  std::set<AgentId> fleet_;
  std::set<AgentId> on_radio_, elsewhere_;  ///< of the fleet: those on this robot's radio, and the others
  BudgetShares shares_;
  SendQueue queue_;
  CloudSender cloud_sender_;
  CloudReceiver cloud_receiver_;
  LoopCloser* loop_closer_;
  Reconcile reconcile_;
  SubmapReceiver submap_receiver_;
  SubmapSender submap_sender_;
  HoldOrders holds_;
  bool drives_ = false;
  bool orders_to_store_ = false;
  std::map<NodeId, Needed> needed_;
  std::map<NodeId, Stamp> without_submap_;  ///< nodes, since when
  Reach link_ = Reach::kLongRange;          ///< of the message that is handled
  std::optional<AgentId> from_;             ///< of the message that is handled, by the link
  AgentStatus status_;
  std::optional<Stamp> next_status_;
  std::optional<std::uint16_t> session_;
  std::set<AgentId> present_;  ///< BudgetShares::present of this tick
  std::map<AgentId, Stamp> busy_until_;
  std::uint64_t sent_before_status_ = 0;  ///< wire bytes
  std::set<AgentId> in_reach_;            ///< heard on the short range
  std::set<AgentId> near_;                ///< on the short range, with whom messages go both ways
  std::vector<Message> to_near_;          ///< to be sent to all of them
  std::optional<Stamp> next_near_digest_;
  bool told_of_own_items_ = false;
  bool was_complete_ = false;
  std::vector<Event> events_;
  std::set<AgentId> strangers_told_of_;
  std::uint64_t strangers_ = 0;
  std::uint64_t bad_requests_ = 0;
  std::array<std::uint64_t, kItemProofs> proofs_{};
  std::set<std::tuple<AgentId, AgentId, ItemProof>> refusals_told_of_;  ///< maker, who handed it over
};

}  // namespace fleetmap::exchange
