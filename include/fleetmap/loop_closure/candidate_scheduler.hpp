#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/cloud_client.hpp"
#include "fleetmap/geometry/uncertain_pose.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/loop_closure/peer_candidates.hpp"

namespace fleetmap::loop_closure {

/// Counters of the loop candidates with other robots since the start.
struct CandidateStats {
  std::uint64_t by_position = 0;    ///< pairs within r^i (Alg. 2), or found so by a peer
  std::uint64_t by_descriptor = 0;  ///< descriptor matches, where not both nodes have a good G
  std::uint64_t by_transform = 0;   ///< pairs within r^i by an inter-frame transform, likewise
  std::uint64_t redundant = 0;      ///< dropped or refused, too near to another candidate
  std::uint64_t requested = 0;      ///< clouds
  std::uint64_t accepted = 0;
  std::uint64_t rejected = 0;
  std::uint64_t lost = 0;  ///< the cloud was not received
  std::uint64_t ended_by_peer =
      0;                      ///< requested, and ended by the peer's good alignment before the cloud arrived
  std::uint64_t yielded = 0;  ///< requested, and dropped in favour of the pair that the peer had selected
  std::uint64_t overflowed = 0;     ///< dropped when too many waited
  std::uint64_t uninformative = 0;  ///< dropped while the radio was busy: below min_information
};

/// A candidate whose cloud was received: to be registered, and answered by on_alignment() or on_rejected().
struct ReceivedCloud {
  LoopCandidate candidate;
  Bytes cloud;  ///< of candidate.source, encoded
};

struct ScheduledCandidate;

/// Schedules the candidates with other robots: which pairs of nodes are registered, and in which order.
///
/// Each node is paired with nodes of other robots by position, descriptor and inter-frame transform. A
/// candidate waits until both clouds are complete, has its cloud requested in the order of information,
/// is registered, and ends as done or failed; a failed one is tried once more. Both robots find the same
/// pairs from the same nodes. If a node was lost on the way and they chose different pairs at one place, the
/// match messages show it, and the smaller pair wins on both.
class CandidateScheduler final : public exchange::CloudClient {
 public:
  CandidateScheduler(const AgentId& self, const CandidateConfig& config);
  ~CandidateScheduler() override;
  CandidateScheduler(const CandidateScheduler&) = delete;
  CandidateScheduler& operator=(const CandidateScheduler&) = delete;

  void on_node(const graph::Node& node, Stamp now) override;
  void on_contested(const NodeId& node) override;
  void on_alignment(const graph::Alignment& alignment, Stamp now) override;
  void on_match(const messages::ProximityMatch& match, Stamp now) override;
  void on_heard(const AgentId& peer, Stamp now) override { heard_[peer] = now; }
  void on_cloud_request(const AgentId& peer, const NodeId& ours) override;
  void on_cloud(const NodeId& theirs, Bytes cloud) override;
  void on_cloud_lost(const NodeId& theirs, Stamp now) override;
  exchange::CloudDemand tick(Stamp now, bool radio_has_room = false) override;
  bool wants(const NodeId& theirs) const override;
  bool idle(Stamp now, const std::set<AgentId>& without = {}) const override;

  /// The alignments that the fleet's graph uses now (graph::Placement::used).
  void on_used_alignments(std::span<const graph::Alignment> used);
  /// This robot's registration of the pair was rejected. (An accepted one is reported by on_alignment.)
  void on_rejected(const NodePair& pair, Stamp now);
  /// Candidates whose clouds were received since the last call.
  std::vector<ReceivedCloud> take_received();
  /// T_ours_theirs by an inter-frame transform; none if both nodes have a good G, if the two frames have no
  /// transform, or while it is distrusted.
  std::optional<UncertainPose> transform(const NodePair& pair) const;
  bool has_good_alignment(const AgentId& peer) const;
  CandidateStats stats() const;
  /// By the other robot; those without a candidate are left out.
  std::map<AgentId, PeerCandidates> by_peer(Stamp now) const;

 private:
  struct State;
  /// Offers a candidate found by a transform; an existing candidate is marked as found by it.
  void offer_by_transform(const LoopCandidate& candidate, Stamp now);
  void yield_to(const NodePair& pair);
  void request(exchange::CloudDemand& demand, Stamp now, bool radio_has_room);
  void announce(exchange::CloudDemand& demand, Stamp now);
  bool heard(const AgentId& peer, Stamp now) const;

  AgentId self_;
  CandidateConfig config_;
  std::unique_ptr<State> state_;
  std::map<AgentId, Stamp> heard_;
  std::vector<NodePair> withdrawn_;
  std::vector<ReceivedCloud> received_;
  CandidateStats stats_;  ///< without what the set counts
};

}  // namespace fleetmap::loop_closure
