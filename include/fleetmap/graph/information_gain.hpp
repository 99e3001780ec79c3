#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// Information that one more alignment of two nodes would add to the fleet's graph, in nats.
///
/// It is the growth of log det of the graph's information matrix (D-optimality; Khosoussi et al., "Reliable
/// Graphs for SLAM", IJRR 2019). For a graph with one scalar variance this is 0.5 ln(1 + P / R), where P is
/// the effective resistance between the two nodes (the variance that odometry, alignments and GPS on all
/// paths between them leave) and R the variance of an alignment. A covariance is reduced to a scalar as the
/// mean square displacement of a point kLever away.
class InformationGain {
 public:
  using Pair = std::pair<NodeId, NodeId>;

  static constexpr double kLever = 10.0;  ///< m

  /// In any order.
  void add(const Node& node);
  /// Replaces all alignments by those that the fleet's graph uses now.
  void use(std::span<const Alignment> used);
  /// Adds one that the graph has not classified yet.
  void add(const Alignment& alignment);

  /// The information gain of each pair, given that the pairs in `expected` will be aligned too. Pairs of
  /// unknown nodes gain 0.
  std::vector<double> of(std::span<const Pair> pairs, std::span<const Pair> expected) const;

 private:
  struct TrackNode {
    FrameId frame;
    double variance = 0.0;  ///< m^2, of the odometry since the node before
  };
  struct Fix {
    NodeId node;
    double variance = 0.0;  ///< m^2
  };
  struct Edge {
    Pair pair;
    double variance = 0.0;  ///< m^2
  };
  class Network;
  /// m^2, variance of the odometry from `from` to `to`, of one frame. The variance of lost nodes is
  /// estimated from the node after them.
  double along_track(const NodeId& from, const NodeId& to) const;

  std::map<NodeId, TrackNode> track_nodes_;
  std::map<FrameId, Fix> fixes_;  ///< the best of each frame
  std::vector<Edge> alignments_;
};

}  // namespace fleetmap::graph
