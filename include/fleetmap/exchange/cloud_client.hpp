#pragma once

#include <compare>
#include <set>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::ProximityMatch;

/// A node of this robot and one of another. Both robots form the same pair from the same nodes.
struct NodePair {
  NodeId ours;
  NodeId theirs;
  auto operator<=>(const NodePair&) const = default;
};

/// Messages and clouds that loop closing demands from the transport in one tick.
struct CloudDemand {
  struct Wanted {
    NodeId node;
    double information = 0.0;  ///< nats, of the alignment that the cloud makes possible
  };
  std::vector<ProximityMatch> matches;  ///< to be sent to the peers
  std::vector<Wanted> wanted;           ///< clouds to request
  std::vector<NodePair> withdrawn;      ///< neither cloud is needed any more
};

/// Interface of loop closing to the transport. The transport reports items, matches, requests and received
/// clouds in the order of their arrival, and each complete cloud once.
class CloudClient {
 public:
  virtual ~CloudClient() = default;

  /// A node was stored, or is in the store at the start; in any order.
  virtual void on_node(const graph::Node& node, Stamp now) = 0;
  /// The name of a node became contested: the node is in no pair any more.
  virtual void on_contested(const NodeId& node) = 0;
  /// An alignment was stored, computed by any robot.
  virtual void on_alignment(const graph::Alignment& alignment, Stamp now) = 0;
  virtual void on_match(const ProximityMatch& match, Stamp now) = 0;
  /// Any message of `peer` was received.
  virtual void on_heard(const AgentId& peer, Stamp now) = 0;
  /// `peer` requested the cloud of our node.
  virtual void on_cloud_request(const AgentId& peer, const NodeId& ours) = 0;
  /// The whole encoded cloud of `theirs` was received.
  virtual void on_cloud(const NodeId& theirs, Bytes cloud) = 0;
  /// The transfer of the cloud of `theirs` has failed, or could not begin.
  virtual void on_cloud_lost(const NodeId& theirs, Stamp now) = 0;
  /// `radio_has_room`: a cloud of little information delays nothing.
  virtual CloudDemand tick(Stamp now, bool radio_has_room) = 0;
  /// A candidate waits for the cloud of `theirs`.
  virtual bool wants(const NodeId& theirs) const = 0;
  /// Nothing is under way or about to be, but for candidates with the agents in `without`.
  virtual bool idle(Stamp now, const std::set<AgentId>& without) const = 0;
};

}  // namespace fleetmap::exchange
