#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include "cloud_transfer.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_client.hpp"
#include "fleetmap/exchange/exchange_config.hpp"
#include "fleetmap/exchange/exchange_events.hpp"
#include "fleetmap/exchange/send_queue.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::CloudFragment;
using messages::CloudRequest;

/// Exchange of spherized clouds and of the matches that precede them, as loop closing demands.
class CloudExchange {
 public:
  /// The references outlive this.
  CloudExchange(const CloudTransferConfig& config, const store::Store& store, CloudClient& cloud_client,
                SendQueue& queue, std::vector<Event>& events);

  /// Answers CloudNeeded: sends the cloud to all robots that have requested it.
  Status provide(const NodeId& node, Bytes cloud, Stamp now);
  /// Answers CloudNeeded: there is no cloud.
  void decline(const NodeId& node) { needed_.erase(node); }
  /// Ends the transfer of a cloud whose alignment this robot has computed itself.
  void on_own_alignment(const graph::Alignment& alignment);
  void on_fragment(const CloudFragment& fragment, Stamp now);
  void on_request(const CloudRequest& request, Stamp now);
  void tick(bool radio_has_room, Stamp now);

  /// Nothing waits for a cloud, but for clouds of the robots in `without`.
  bool idle(const std::set<AgentId>& without) const { return needed_.empty() && receiver_.idle(without); }
  const CloudSenderStats& sender_stats() const { return sender_.stats(); }
  const CloudReceiverStats& receiver_stats() const { return receiver_.stats(); }
  /// Requests of clouds of nodes that are not own ones.
  std::uint64_t bad_requests() const { return bad_requests_; }
  std::size_t clouds_to_make() const { return needed_.size(); }

 private:
  struct Needed {
    std::map<AgentId, float> by;  ///< with the information of each request, nats
    Stamp notified;               ///< when CloudNeeded was last emitted
  };
  void send(std::vector<CloudFragment> fragments, float information);

  AgentId self_;
  CloudTransferConfig config_;
  const store::Store& store_;
  CloudClient& cloud_client_;
  SendQueue& queue_;
  std::vector<Event>& events_;
  CloudSender sender_;
  CloudReceiver receiver_;
  std::map<NodeId, Needed> needed_;  ///< own clouds requested and not yet made
  std::uint64_t bad_requests_ = 0;
};

}  // namespace fleetmap::exchange
