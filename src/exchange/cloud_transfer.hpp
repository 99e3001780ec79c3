#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_transfer_config.hpp"
#include "fleetmap/exchange/exchange_stats.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::CloudFragment;
using messages::CloudRequest;

/// The pieces that `cloud` travels in, all but `to` and `from` derived from it.
std::vector<CloudFragment> split_cloud(const AgentId& from, const AgentId& to, const NodeId& node,
                                       const Bytes& cloud);

/// Serves the agent's own spherized clouds.
class CloudSender {
 public:
  CloudSender(const AgentId& self, const CloudTransferConfig& config);

  /// A cloud that the agent made. Fails when it is larger than the budget or empty.
  Status offer(const NodeId& node, Bytes cloud, Stamp now);
  /// Pieces that answer a request; nothing when the cloud has to be made first.
  std::optional<std::vector<CloudFragment>> answer(const CloudRequest& request, Stamp now);
  const CloudSenderStats& stats() const { return stats_; }

 private:
  struct Kept {
    Bytes cloud;
    Stamp made;
  };
  AgentId self_;
  CloudTransferConfig config_;
  std::map<NodeId, Kept> kept_;
  CloudSenderStats stats_;
};

/// Reassembles clouds of other robots and requests missing pieces.
class CloudReceiver {
 public:
  CloudReceiver(const AgentId& self, const CloudTransferConfig& config);

  /// Requests a node's cloud from its robot, for an alignment of `information` nats. False if too many
  /// transfers are under way; true if this one is, or was before.
  bool want(const NodeId& node, Stamp now, double information = 0.0);
  void cancel(const NodeId& node);
  /// The whole cloud when `fragment` was the last piece.
  std::optional<Bytes> add(const CloudFragment& fragment, Stamp now);
  struct Due {
    std::vector<CloudRequest> requests;
    std::vector<NodeId> abandoned;
  };
  Due tick(Stamp now);

  /// No cloud is waited for, but for those of the agents in `without`.
  bool idle(const std::set<AgentId>& without = {}) const;
  bool waits_for(const NodeId& node) const { return waiting_.contains(node); }
  bool full() const { return waiting_.size() >= config_.max_receiving; }
  const CloudReceiverStats& stats() const { return stats_; }

 private:
  struct Waiting {
    ContentHash hash{};
    Bytes cloud;  ///< empty until the first fragment
    std::vector<bool> held;
    std::size_t missing = 0;
    Stamp deadline;
    double information = 0.0;   ///< nats
    int tries = 0;              ///< requests since the last piece
    bool contradicted = false;  ///< pieces of another cloud of the same node arrived
    int restarts = 0;           ///< transfers that began again: contradicted or with the wrong hash
    /// Discards the received pieces.
    void begin_anew() {
      Waiting anew;
      anew.information = information;
      anew.restarts = restarts + 1;
      *this = std::move(anew);
    }
  };
  bool consistent(const CloudFragment& fragment) const;
  CloudRequest request(const NodeId& node, Waiting& waiting, Stamp now);

  AgentId self_;
  CloudTransferConfig config_;
  std::map<NodeId, Waiting> waiting_;
  CloudReceiverStats stats_;
};

}  // namespace fleetmap::exchange
