#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/exchange/item_proof.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/messages/routing.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::AgentStatus;
using messages::HoldOrder;
using messages::MissionReport;
using messages::Reach;

/// A node of another robot was stored, or an own one that others returned after our store was lost.
struct NodeAdded {
  NodeId id;
};
/// An alignment of another robot was stored, or an own one that was returned.
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
/// The status of another robot was received.
struct PeerStatus {
  AgentStatus status;
};
/// The mission report of another robot was received.
struct MissionHeard {
  MissionReport report;
};
/// Another order of an operator is in force for this agent.
struct HoldChanged {
  HoldOrder order;
};
/// Rows were given away by an operator, or are given otherwise than before.
struct RowsOrdered {
  std::vector<messages::RowOrder> orders;  ///< all that are in force
};
/// Another content arrived under a name that is taken: a session number was drawn twice, or an item is
/// forged or damaged. Where items are signed, the maker signed both: another robot has its key, as on a
/// copied disk, or the maker equivocates. The name is contested from now on and has no item. An item of the
/// running session that this robot has not made was refused. Own items get new names by reissue_contested().
struct ItemConflict {
  NodeId id;  ///< of the node, or (computed_by, seq) of the alignment
  bool alignment = false;
  Reach link = Reach::kLongRange;  ///< over which it arrived
  bool signed_twice = false;       ///< by its maker
  std::optional<AgentId> from;     ///< the robot that sent it, where the link identifies it
};
/// An item was refused, because its signature does not prove that the robot in its name made it. Reported
/// once for each maker, reason and sender. The genuine item is accepted when it arrives.
struct ItemRefused {
  NodeId id;  ///< of the node, or (computed_by, seq) of the alignment
  bool alignment = false;
  ItemProof proof = ItemProof::kUnsigned;
  Reach link = Reach::kLongRange;  ///< over which it arrived
  std::optional<AgentId> from;     ///< the robot that sent it, where the link identifies it
};
/// The store was of a time without keys, or of other keys.
struct ItemsAdopted {
  AdoptedItems items;
};
/// `peer` offers items that it does not deliver. Completion does not wait for them until it delivers again.
struct OfferUndelivered {
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
inline constexpr std::size_t kMisbehaviourKinds = 4;
/// A robot sent a message that bears another robot's name, or that contradicts the rules or a known item.
/// Digests, chunks and reports bear no signatures, so `from` alone identifies the sender. Reported once for
/// each robot and kind, and counted in ExchangeStats::misbehaved.
struct SenderMisbehaved {
  enum class Kind : std::uint8_t { kForeignName, kDigest, kCloud, kSubmap };
  AgentId name;                 ///< in the message
  std::optional<AgentId> from;  ///< the robot that sent it, where the link identifies it
  Kind kind = Kind::kForeignName;
  Reach link = Reach::kLongRange;  ///< over which it arrived
};
/// A robot that is not of the fleet was heard. Told once of each.
struct StrangerHeard {
  AgentId name;
};
/// The store's file failed; nothing that failed was accepted.
struct StoreFailed {
  Error error;
};
/// Every known item is held. Reported again after more became known and was completed.
struct MapComplete {
  std::size_t nodes = 0;
  std::size_t alignments = 0;
};
using Event =
    std::variant<NodeAdded, AlignmentAdded, SubmapAdded, CloudNeeded, PeerStatus, MissionHeard, HoldChanged,
                 RowsOrdered, ItemConflict, ItemRefused, ItemsAdopted, OfferUndelivered, OwnItemsElsewhere,
                 SessionTaken, SenderMisbehaved, StrangerHeard, StoreFailed, MapComplete>;

}  // namespace fleetmap::exchange
