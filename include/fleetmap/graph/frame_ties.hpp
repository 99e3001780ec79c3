#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/geometry/uncertain_pose.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// How nodes of two odometry frames lie to each other where no GPS tells: by an alignment of the two frames
/// and the odometry on both sides of it.
class FrameTies {
 public:
  using FramePair = std::pair<FrameId, FrameId>;

  /// So many alignments tie two frames: in rows that repeat, one alone may be one row off.
  static constexpr std::size_t kLeast = 3;

  /// In any order. Odometry is followed only where no node between is missing.
  void add(const Node& node);
  /// What the fleet's graph uses now (Placement::used), instead of what it used before. Their nodes must have
  /// been added; those of one frame, and those whose nodes are unknown, do not count.
  void use(std::span<const Alignment> used);

  /// The frames that are tied, each pair both ways round, and T_a_b of the two by the first alignment.
  std::map<FramePair, Pose> tied() const;
  /// T_i_j and what it is worth, along the alignment that is nearest on the two paths; none where the frames
  /// are not tied, or nodes are missing on the way to each of the alignments.
  std::optional<UncertainPose> between(const NodeId& i, const NodeId& j) const;
  struct Neighbour {
    NodeId id;
    double distance = 0.0;  ///< m, in the plane that `node` stands on, by one alignment
  };
  /// Of the nodes of `agent` in frames that are tied to that of `node`, the nearest. Linear in their number.
  std::optional<Neighbour> nearest(const NodeId& node, const AgentId& agent) const;

 private:
  struct Place {
    FrameId frame;
    Pose T_odom_base = Pose::Identity();
    Matrix6d odom_covariance = Matrix6d::Zero();  ///< since the node before
  };
  struct Tie {
    NodeId i, j;
    UncertainPose T_i_j;
  };
  Pose T_odom_odom(const Tie& tie) const;
  std::optional<UncertainPose> odometry(const NodeId& from, const NodeId& to) const;

  std::map<NodeId, Place> places_;
  std::map<FramePair, std::vector<Tie>> ties_;  ///< each both ways round
};

}  // namespace fleetmap::graph
