#pragma once

#include <optional>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/signature.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::graph {

/// An odometry frame: each start of an agent's program begins a new one.
struct FrameId {
  AgentId agent;
  std::uint16_t session = 0;  ///< session_of() its nodes' numbers
  auto operator<=>(const FrameId&) const = default;
};

/// A frozen place of one agent: (G, O) of the paper's Alg. 1, a submap, and a vertex of the fleet graph.
/// Never changes once made, and holds exactly what fits on the wire, so that every agent computes with the
/// same numbers.
struct Node {
  NodeId id;
  std::uint16_t session = 0;  ///< the odometry frame of O is that of FrameId{id.agent, session}
  Stamp stamp;
  /// T_enu_base at `stamp`, with covariance; none without GPS, for example indoors.
  std::optional<GlobalPose> G;
  Pose T_odom_base = Pose::Identity();  ///< O: base_link in the agent's odometry frame at `stamp`
  /// Covariance of the odometry since the previous node of the same frame: right tangent of T_previous_this,
  /// [m, rad]. It adds up along a chain of nodes. The error of each pose within the local map (millimetres)
  /// does not add up and is left out. Without meaning for the first node of a frame.
  Matrix6d odom_covariance = Matrix6d::Zero();
  /// Against gravity, in base_link: about 1 long.
  Eigen::Vector3d up_in_base = Eigen::Vector3d::UnitZ();
  /// Descriptor of the surroundings (place::Descriptor::encode()) for place recognition without GPS; empty
  /// if the scan had too little structure. At most kMaxDescriptorBytes.
  Bytes descriptor;
  /// Names the encoded submap (the points seen since the last node, in base_link at `stamp`).
  ContentHash submap_hash{};
  std::uint32_t submap_bytes = 0;  ///< size of the encoded submap
  /// Signature of the maker over all other fields, including the submap's hash; none in a fleet without
  /// keys.
  std::optional<Signature> signature{};

  static constexpr std::size_t kMaxDescriptorBytes = 200;

  FrameId frame() const { return {id.agent, session}; }
};

}  // namespace fleetmap::graph
