#pragma once

#include <map>
#include <span>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/fleet_placement.hpp"

namespace fleetmap::graph {

/// A node that is a variable of the graph: an end of its frame, an end of an alignment, or the first node of
/// a window of GPS fixes. The nodes between two pillars follow from them and the odometry.
struct Pillar {
  std::size_t node = 0;   ///< in ReducedGraph::nodes
  std::size_t frame = 0;  ///< in ReducedGraph::frames
  bool has_window = false;
  // The window's fixes as one: their mean, at the mean of the places where the odometry saw them.
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();           ///< m, in base_link of the pillar
  Eigen::Vector3d fix = Eigen::Vector3d::Zero();             ///< m, ENU
  Eigen::Vector3d drift_sigma = Eigen::Vector3d::Zero();     ///< m, of the part that drifts, east, north, up
  Eigen::Vector3d rest_variance = Eigen::Vector3d::Ones();   ///< m^2, of what is left
  double seconds = 0.0;                                      ///< since the first node of the fleet
  Eigen::Matrix3d R_enu_base = Eigen::Matrix3d::Identity();  ///< of G
  Eigen::Vector3d rotation_variance = Eigen::Vector3d::Ones();  ///< rad^2, about the axes of ENU
};

/// A relative pose that was measured between two pillars.
struct Between {
  std::size_t a = 0, b = 0;
  Pose T_a_b = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();   ///< right tangent of T_a_b
  Matrix6d information = Matrix6d::Identity();  ///< its inverse

  Between() = default;
  Between(std::size_t from, std::size_t to, const Pose& T_from_to, const Matrix6d& C);
};

/// The drifts of two windows that follow each other: drift_b = decay * drift_a + noise, unit variance, axis
/// by axis.
struct DriftLink {
  std::size_t a = 0, b = 0;
  Eigen::Vector3d decay = Eigen::Vector3d::Zero();
};

struct FrameSpan {
  FrameId id;
  std::size_t first = 0, end = 0;                ///< in ReducedGraph::nodes
  std::size_t first_pillar = 0, end_pillar = 0;  ///< in ReducedGraph::pillars
};

/// The fleet's nodes without alignments, reduced to pillars.
struct ReducedGraph {
  std::vector<const Node*> nodes;  ///< by frame, then by seq
  std::vector<FrameSpan> frames;
  std::vector<Pillar> pillars;    ///< in the order of the nodes
  std::vector<Between> odometry;  ///< between consecutive pillars of a frame
  std::vector<DriftLink> drift;
  std::map<NodeId, std::size_t> pillar_of;  ///< ends of alignments
};

/// Covariance of the odometry from the node before `k` to `k`, in a frame.
Matrix6d odometry_step(const ReducedGraph& graph, std::size_t k);

/// `ends` are the nodes that must be pillars. Nodes must be valid.
ReducedGraph reduce(std::span<const Node* const> nodes, std::span<const NodeId> ends, const LocalFrame& site,
                    const FleetPlacementConfig& config);

}  // namespace fleetmap::graph
