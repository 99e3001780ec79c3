#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/place/proximity_search.hpp"
#include "frame_transforms.hpp"
#include "node_index.hpp"

namespace fleetmap::loop_closure {

/// Candidates with other robots by inter-frame transforms, for pairs of which not both nodes are located: the
/// nearest node of the other robot, if it lies within r^i of Eq. 1. Several rejections in a row make a
/// transform distrusted until it changes or a candidate with the robot is accepted.
class TransformCandidates {
 public:
  /// `nodes` outlives this, and holds every node before it is added here.
  TransformCandidates(const AgentId& self, const place::ProximityConfig& config, const NodeIndex& nodes)
      : self_(self), config_(config), nodes_(nodes) {}

  /// Adds a node, and pairs it with the nearest of each robot that it may pair with. Nodes made after it, to
  /// which it completes the odometry, are to be searched again.
  std::vector<LoopCandidate> propose(const graph::Node& node);
  /// The candidates of up to `searches` nodes that are to be searched again.
  std::vector<LoopCandidate> propose_pending(std::size_t searches);
  bool pending() const { return !pending_.empty(); }
  void remove(const NodeId& node);

  /// The alignments that the fleet's graph uses now. Returns the frames (ours, theirs) whose transform is new
  /// or has changed: all of their nodes are to be searched again.
  std::vector<FrameTransforms::FramePair> on_used_alignments(std::span<const graph::Alignment> used);
  /// A candidate that a transform found, or gave the prior for, was rejected. True: this makes the transform
  /// distrusted.
  bool on_rejected(const AgentId& peer);
  void on_accepted(const AgentId& peer) { rejections_.erase(peer); }

  /// T_ours_theirs; none where both nodes are located, the frames have no transform, or it is distrusted.
  std::optional<UncertainPose> transform(const NodePair& pair) const;

 private:
  struct Known {
    Pose T_ours_theirs = Pose::Identity();  ///< odometry frames
    bool searched = false;                  ///< all nodes of both frames were, or are about to be
  };
  bool distrusted(const AgentId& peer) const;
  /// The transform may be used for the pair.
  bool usable(const NodePair& pair) const;
  std::optional<LoopCandidate> search(const NodeId& node, const AgentId& other) const;
  void search_later_nodes(const NodeId& node);
  void search_frames(const FrameTransforms::FramePair& frames);

  AgentId self_;
  place::ProximityConfig config_;
  const NodeIndex& nodes_;
  FrameTransforms transforms_;
  std::map<FrameTransforms::FramePair, Known> known_;  ///< ours, theirs
  std::map<AgentId, int> rejections_;                  ///< since the last that was accepted
  std::set<std::pair<NodeId, AgentId>> pending_;       ///< a node, and whose nearest is to be searched
};

}  // namespace fleetmap::loop_closure
