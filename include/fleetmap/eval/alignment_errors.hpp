#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/eval/consistency.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/graph/placement.hpp"

/// Errors of alignments, odometry and placement against the true poses of the nodes. Only relative poses
/// count, so the frame of the truth does not matter.
namespace fleetmap::eval {

/// T_truth_base of each node at its stamp.
using TruePoses = std::map<NodeId, Pose>;

/// T_truth_enu that lays the placed nodes on where they truly were: the mean shift and the best turn about
/// the vertical, which both frames share. Identity without nodes in common.
Pose laid_on_truth(const std::map<NodeId, Pose>& T_enu_node, const TruePoses& truth);

/// Tolerance within which an alignment counts as right.
struct RightPose {
  double translation = 0.5;                ///< m
  double rotation = 0.034906585039886591;  ///< rad, 2 deg
};

/// An alignment against the truth.
struct AlignmentError {
  NodeId i, j;
  bool ambiguous = false;
  bool used = false;            ///< by the placement
  bool between_robots = false;  ///< else a loop of one robot
  /// The following fields describe one mode: the one that the placement used, else the best.
  double translation = 0.0;  ///< m
  double rotation = 0.0;     ///< rad
  bool right = false;        ///< within RightPose
  bool holds_right = false;  ///< one of its modes is right
  Eigen::Vector3d offset;    ///< m, error of where j lies, in base_link of i: along, across, up
  StatedError stated;        ///< right tangent of T_i_j
};
/// Those of which both nodes' true poses are known.
std::vector<AlignmentError> alignment_errors(std::span<const graph::Alignment> alignments,
                                             const graph::Placement& placement, const TruePoses& truth,
                                             const RightPose& limits = {});

/// Nodes of one piece of odometry_errors(): some 35 m of path.
inline constexpr std::uint32_t kOdometryPiece = 8;

/// Errors of the odometry over pieces of kOdometryPiece nodes of one frame, one after the other, with what
/// the nodes on the way state: they state what sums, and not by how much each pose lies off in the local map.
/// Nodes that state nothing end a piece.
std::vector<StatedError> odometry_errors(std::span<const graph::Node> nodes, const TruePoses& truth);

/// Two robots that alignments connect.
struct JoinedPair {
  AgentId a, b;
  std::size_t pairs = 0;     ///< pairs of nodes that an alignment names
  double translation = 0.0;  ///< m, median error of the placed relative pose over them
  double rotation = 0.0;     ///< rad, likewise
  bool right = false;
};
/// Whether the robots are joined rightly where they met: of every pair with an alignment in use, directly.
std::vector<JoinedPair> joined_pairs(std::span<const graph::Alignment> alignments,
                                     const graph::Placement& placement, const TruePoses& truth,
                                     const RightPose& limits = {});

}  // namespace fleetmap::eval
