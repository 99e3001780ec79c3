#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_client.hpp"
#include "fleetmap/exchange/exchange_config.hpp"
#include "fleetmap/exchange/exchange_events.hpp"
#include "fleetmap/exchange/exchange_stats.hpp"
#include "fleetmap/exchange/send_queue.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/messages/routing.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::AgentStatus;
using messages::HoldOrder;
using messages::Message;
using messages::MissionReport;
using messages::Outgoing;
using messages::Reach;
using messages::RowOrder;

/// Exchange of one robot with the others, as a state machine: messages and time in, messages and events out.
/// A message for one robot goes over the short range if the two are near (its digests arrive there and name
/// this robot), else over the radio. Call tick() at 10 Hz or more (50 Hz while submaps flow), then
/// take_events().
class Exchange {
 public:
  /// `store` and `cloud_client` outlive this. Starts from the items in the store; unfinished loop candidates
  /// are found again.
  static Result<Exchange> make(const ExchangeConfig& config, store::Store& store, CloudClient& cloud_client,
                               Stamp now);
  Exchange(Exchange&&) noexcept;
  Exchange& operator=(Exchange&&) noexcept;
  ~Exchange();

  /// Sets the running session. Items of this robot with its number that are not in the store are refused from
  /// now on (ItemConflict).
  void begin_session(std::uint16_t session);
  /// Stores an own node with its encoded submap and sends it to all. All robots must hold equal items, so the
  /// node must equal its encoded form (decode(encode(node))). kConflict: the name is taken.
  Result<store::Put> on_own_node(const graph::Node& node, ByteView submap, Stamp now);
  /// Stores and sends an accepted registration of this robot; the rule for nodes holds here too.
  Result<store::Put> on_own_alignment(const graph::Alignment& alignment, Stamp now);
  /// Answers CloudNeeded. Fails if the cloud exceeds the byte budget.
  Status provide_cloud(const NodeId& node, Bytes cloud, Stamp now);
  /// Answers CloudNeeded if the cloud cannot be made.
  void decline_cloud(const NodeId& node);
  /// Sets position, heading, battery and `busy` (more nodes will be made) of the next status messages; the
  /// other fields are filled in.
  void set_status(const AgentStatus& status);
  /// Sends this robot's part of the mission to all. A report that still waits is replaced.
  void send_report(MissionReport report);
  /// Whether this robot drives a mission, as its answers to operators report. By default it does not.
  void set_drives(bool drives);
  /// Sends an order that was issued on this robot itself to all. An order with stamp zero gets a stamp that
  /// replaces all others.
  void on_local_order(HoldOrder order, Stamp now);
  void on_local_order(RowOrder order, Stamp now);
  /// The order in force for this robot; none if there never was one. It survives a restart.
  std::optional<HoldOrder> hold_in_force() const;
  /// The orders for each robot and for all, as far as they were received.
  std::vector<HoldOrder> hold_orders() const;
  /// Which rows operators gave away. They survive a restart, too.
  std::vector<RowOrder> row_orders() const;

  /// `message` arrived over `link`, from the robot `from` where the link identifies it. An item may arrive
  /// from another robot than its maker.
  void on_message(const Message& message, Reach link, Stamp now, std::optional<AgentId> from = std::nullopt);
  void on_message(const Message& message, Stamp now) { on_message(message, usual_reach(message), now); }
  /// The radio itself has sent `bytes` on the wire to discover other robots: they count against the share.
  void on_discovery(std::size_t bytes, Stamp now);
  std::vector<Outgoing> tick(Stamp now);
  std::vector<Event> take_events();

  /// Every node, alignment and submap that any robot offers is held. Exceptions: items that a robot offers
  /// but does not deliver, submaps that all other robots deny to hold, and, of the robots in `without`, which
  /// are lost, items that no other robot holds.
  bool complete(const std::set<AgentId>& without = {}) const;
  /// By their digests all other robots, except those in `without`, hold the nodes and alignments of this one.
  bool fleet_caught_up(const std::set<AgentId>& without = {}) const;
  /// Nothing waits to be sent, fetched or registered, except what concerns the robots in `without`.
  bool idle(Stamp now, const std::set<AgentId>& without = {}) const;
  /// By its last status a robot that is still heard will make more nodes or alignments.
  bool others_busy(Stamp now) const;
  /// The last status of each robot; that of this one is the present one.
  std::map<AgentId, AgentStatus> statuses() const;
  /// Whether each robot is held by an order, by its last answer; without an order there are no answers.
  std::map<AgentId, messages::Hold::Driving> driving() const;
  ExchangeStats stats() const;
  TableSizes table_sizes() const;
  const SendQueue& queue() const;
  /// Robots heard on the short range within SubmapTransferConfig::peer_timeout.
  std::vector<AgentId> peers_in_reach(Stamp now) const;
  /// Robots that submaps are being fetched from.
  std::vector<AgentId> submap_requesters() const;
  /// Robots in reach that hold the same submaps: nothing is left to be exchanged with them.
  std::vector<AgentId> in_sync_with(Stamp now) const;

 private:
  struct State;
  explicit Exchange(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::exchange
