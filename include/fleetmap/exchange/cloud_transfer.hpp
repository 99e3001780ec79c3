#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::CloudFragment;
using messages::CloudRequest;

/// Which cloud of several goes over the radio first.
enum class CloudOrder : std::uint8_t {
  kInformation,  ///< that with the most information, as its receiver expects
  kFirstCome,    ///< that which was requested first
};

struct CloudTransferConfig {
  std::uint32_t max_cloud_bytes = 25'600;        ///< B, 25,000 of payload and a header
  std::size_t max_kept = 16;                     ///< encoded own clouds kept for repeated requests
  Duration kept_for = std::chrono::seconds(60);  ///< then a request asks the agent for a fresh one
  std::size_t max_receiving = 8;                 ///< clouds received at once
  Duration first_timeout =
      std::chrono::seconds(6);  ///< s of silence before asking again; the peer computes and queues
  Duration gap_timeout =
      std::chrono::seconds(2);  ///< s of silence within a cloud before asking for what is missing
  double backoff = 1.6;         ///< timeouts grow by this with every try that brought nothing
  Duration max_timeout = std::chrono::seconds(30);
  int max_tries = 8;  ///< requests in a row that brought nothing, then it is given up
  CloudOrder order = CloudOrder::kInformation;
  /// An own good alignment ends the transfer of our cloud to the peer, which stops as well when it hears of
  /// it (LoopClosureConfig::stop_when_peer_aligned).
  bool cancel_when_aligned = true;
  Status validate() const;
};

/// The pieces that `cloud` travels in, all but `to` and `from` derived from it.
std::vector<CloudFragment> split_cloud(const AgentId& from, const AgentId& to, const NodeId& node,
                                       const Bytes& cloud);

struct CloudSenderStats {
  std::uint64_t offered = 0;       ///< clouds
  std::uint64_t too_large = 0;     ///< clouds refused
  std::uint64_t bad_requests = 0;  ///< pieces asked for that do not exist
};

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

struct CloudReceiverStats {
  std::uint64_t received = 0;  ///< whole clouds with the right hash
  std::uint64_t given_up = 0;
  std::uint64_t bad_hash = 0;    ///< whole clouds with the wrong hash
  std::uint64_t duplicates = 0;  ///< fragments held already
  std::uint64_t unasked = 0;     ///< fragments of clouds that nobody waits for
  std::uint64_t hostile = 0;     ///< fragments whose numbers contradict themselves, the rules or each other
  std::uint64_t requests = 0;
};

/// Puts clouds of other agents together again, and asks for what is missing.
class CloudReceiver {
 public:
  CloudReceiver(const AgentId& self, const CloudTransferConfig& config);

  /// Starts asking the node's agent for its cloud, for an alignment of `worth` nats. False when too many are
  /// under way; true when it is or was asked.
  bool want(const NodeId& node, Stamp now, double worth = 0.0);
  void cancel(const NodeId& node);
  /// The whole cloud when `fragment` was the last piece.
  std::optional<Bytes> add(const CloudFragment& fragment, Stamp now);
  struct Due {
    std::vector<CloudRequest> requests;
    std::vector<NodeId> given_up;
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
    double worth = 0.0;         ///< nats
    int tries = 0;              ///< requests since the last piece
    bool contradicted = false;  ///< pieces of another cloud of the same node came
    int restarts = 0;           ///< clouds thrown away half way or with the wrong hash
    /// Throws away what came.
    void begin_anew() {
      Waiting anew;
      anew.worth = worth;
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
