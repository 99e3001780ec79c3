#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/geometry/uncertain_pose.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::loop_closure {

/// Inter-frame transforms: how nodes of two odometry frames lie to each other by an alignment of the two
/// frames and the odometry on both sides of it.
class FrameTransforms {
 public:
  using FramePair = std::pair<graph::FrameId, graph::FrameId>;

  /// Alignments that a transform needs: in rows that repeat one alone may be one row off.
  static constexpr std::size_t kMinAlignments = 3;

  /// In any order. Odometry is followed only where no node between is missing.
  void add(const graph::Node& node);
  /// The alignments that the fleet's graph uses now (Placement::used), instead of those before. Their nodes
  /// must have been added; alignments within one frame or of unknown nodes are ignored.
  void use(std::span<const graph::Alignment> used);

  /// T_a_b of all pairs of frames with a transform, both ways round, by the first alignment.
  std::map<FramePair, Pose> known() const;
  /// T_i_j with its covariance, along the alignment that is nearest on the two paths; none if the frames have
  /// no transform, or nodes are missing on the way to each of its alignments.
  std::optional<UncertainPose> between(const NodeId& i, const NodeId& j) const;
  struct Neighbour {
    NodeId id;
    double distance = 0.0;  ///< m, in the plane of `node`, by one alignment
  };
  /// The nearest node of `agent` in frames with a transform to that of `node`. Linear in their number.
  std::optional<Neighbour> nearest(const NodeId& node, const AgentId& agent) const;

 private:
  struct Keyframe {
    graph::FrameId frame;
    Pose T_odom_base = Pose::Identity();
    Matrix6d odom_covariance = Matrix6d::Zero();  ///< since the node before
  };
  struct Constraint {
    NodeId i, j;
    UncertainPose T_i_j;
  };
  Pose T_odom_odom(const Constraint& constraint) const;
  std::optional<UncertainPose> odometry(const NodeId& from, const NodeId& to) const;

  std::map<NodeId, Keyframe> keyframes_;
  std::map<FramePair, std::vector<Constraint>> constraints_;  ///< each both ways round
};

}  // namespace fleetmap::loop_closure
