#pragma once

#include <map>
#include <span>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/fleet_placement_config.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// A node that is a variable of the graph (a keyframe): an end of its frame, an end of an alignment, or the
/// first node of a window of GPS fixes. Nodes between two pose variables follow from these and the odometry.
struct PoseVariable {
  std::size_t node = 0;   ///< in ReducedGraph::nodes
  std::size_t frame = 0;  ///< in ReducedGraph::frames
  bool has_window = false;
  // The window's fixes as one factor: their mean, at the mean of the nodes' positions by the odometry.
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();           ///< m, in base_link of the node
  Eigen::Vector3d fix = Eigen::Vector3d::Zero();             ///< m, ENU
  Eigen::Vector3d drift_sigma = Eigen::Vector3d::Zero();     ///< m, of the part that drifts, east, north, up
  Eigen::Vector3d rest_variance = Eigen::Vector3d::Ones();   ///< m^2, of the part that does not drift
  double seconds = 0.0;                                      ///< since the first node of the fleet
  Eigen::Matrix3d R_enu_base = Eigen::Matrix3d::Identity();  ///< of G
  Eigen::Vector3d rotation_variance = Eigen::Vector3d::Ones();  ///< rad^2, about the axes of ENU
};

/// A measured relative pose between two pose variables.
struct BetweenFactor {
  std::size_t a = 0, b = 0;
  Pose T_a_b = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();   ///< right tangent of T_a_b
  Matrix6d information = Matrix6d::Identity();  ///< its inverse

  BetweenFactor() = default;
  BetweenFactor(std::size_t from, std::size_t to, const Pose& T_from_to, const Matrix6d& C);
};

/// The drifts of two windows that follow each other: drift_b = decay * drift_a + noise, unit variance, axis
/// by axis.
struct DriftFactor {
  std::size_t a = 0, b = 0;
  Eigen::Vector3d decay = Eigen::Vector3d::Zero();
};

struct FrameSpan {
  FrameId id;
  std::size_t first = 0, end = 0;            ///< in ReducedGraph::nodes
  std::size_t first_pose = 0, end_pose = 0;  ///< in ReducedGraph::poses
};

/// The fleet's nodes without alignments, reduced to pose variables.
struct ReducedGraph {
  std::vector<const Node*> nodes;  ///< by frame, then by seq
  std::vector<FrameSpan> frames;
  std::vector<PoseVariable> poses;      ///< in the order of the nodes
  std::vector<BetweenFactor> odometry;  ///< between consecutive pose variables of a frame
  std::vector<DriftFactor> drift;
  std::map<NodeId, std::size_t> pose_of;  ///< index in `poses` of the ends of alignments
};

/// Covariance of the odometry from the node before `k` to `k`, in a frame.
Matrix6d odometry_step(const ReducedGraph& graph, std::size_t k);

/// `ends` are the nodes that must be pose variables. Nodes must be valid.
ReducedGraph reduce(std::span<const Node* const> nodes, std::span<const NodeId> ends, const LocalFrame& site,
                    const FleetPlacementConfig& config);

}  // namespace fleetmap::graph
