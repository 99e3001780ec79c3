#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"

namespace fleetmap::loop_closure {

/// Positions of all nodes for loop closing: on Earth if their G is good enough, and in their odometry
/// frames.
class NodeIndex {
 public:
  struct Entry {
    std::optional<GeoPoint> position;  ///< of a located node
    graph::FrameId frame;
    Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
  };

  /// `max_sigma_m` (m): of a G that locates a node, horizontal.
  NodeIndex(const AgentId& self, double max_sigma_m) : self_(self), max_sigma_m_(max_sigma_m) {}

  bool located(const graph::Node& node) const;
  /// False if the node was added before.
  bool add(const graph::Node& node);
  void remove(const NodeId& node) { entries_.erase(node); }

  /// Null: the node is unknown.
  const Entry* find(const NodeId& node) const;
  bool contains(const NodePair& pair) const { return find(pair.ours) && find(pair.theirs); }
  const std::map<NodeId, Entry>& entries() const { return entries_; }
  /// Both nodes were added, and at least one is not located.
  bool lacks_position(const NodePair& pair) const;
  /// Some node was added that is not located.
  bool any_unlocated() const { return any_unlocated_; }
  /// Nodes that its robot made after `node` in the same session; 0 if it is unknown.
  std::uint32_t nodes_after(const NodeId& node) const;
  /// The agents whose nodes form pairs with those of `agent`: all peers if `agent` is this robot, else this
  /// robot.
  std::vector<AgentId> partners_of(const AgentId& agent) const;
  /// Both nodes were added, have comparable positions, and lie less than `limit` (m) apart.
  bool near(const NodeId& a, const NodeId& b, double limit) const;

 private:
  AgentId self_;
  double max_sigma_m_;
  std::map<NodeId, Entry> entries_;
  std::map<AgentId, std::map<std::uint16_t, std::uint32_t>> newest_;  ///< seq, of each session
  bool any_unlocated_ = false;
};

}  // namespace fleetmap::loop_closure
