#pragma once

#include <cstdint>
#include <optional>

#include "fleetmap/exchange/cloud_client.hpp"
#include "fleetmap/geometry/uncertain_pose.hpp"

namespace fleetmap::loop_closure {

using exchange::NodePair;

/// Two nodes whose clouds are to be registered: the cloud of `source` onto that of `target`. The target is a
/// node of this robot; the source is a node of another robot, or of this one.
struct LoopCandidate {
  enum class Origin : std::uint8_t {
    kPosition,    ///< both G lie within r^i (Alg. 2)
    kDescriptor,  ///< the descriptors match
    kTransform,   ///< near by a transform between the odometry frames, from alignments
    kOdometry,    ///< near by the odometry of one frame
    kPeer,        ///< found by the other robot
  };
  NodeId target;
  NodeId source;
  Origin origin = Origin::kPosition;
  double distance = 0.0;     ///< m, as the origin has it
  double radius = 0.0;       ///< m, within which it was searched
  double match_score = 0.0;  ///< of a descriptor match: similarity + support
  /// The prior of kOdometry and kTransform; the other origins have theirs from the nodes.
  std::optional<UncertainPose> T_target_source = std::nullopt;

  NodePair pair() const { return {target, source}; }
};

}  // namespace fleetmap::loop_closure
