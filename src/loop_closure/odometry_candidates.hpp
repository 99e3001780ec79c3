#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/loop_closure/own_path_config.hpp"

namespace fleetmap::loop_closure {

/// Candidates where a robot returns to its own path within one odometry frame: adjacent rows are driven
/// minutes apart. Uses odometry only, so it needs no GPS.
class OdometryCandidates {
 public:
  explicit OdometryCandidates(const OwnPathConfig& config) : config_(config) {}

  /// Own nodes in their order. At most one candidate a node: the latest complete node with the nearest
  /// earlier one. Its prior is the odometry between the two, with the covariance of the way.
  std::optional<LoopCandidate> propose(const graph::Node& node);

 private:
  std::optional<std::size_t> nearest_earlier(std::size_t later) const;
  UncertainPose odometry(std::size_t earlier, std::size_t later) const;

  OwnPathConfig config_;
  /// The parts of a node that candidates need: a long drive has many nodes.
  struct Step {
    NodeId id;
    Pose T_odom_base = Pose::Identity();
    Matrix6d odom_covariance = Matrix6d::Zero();  ///< since the node before
  };
  graph::FrameId frame_;                    ///< the current one
  std::vector<Step> steps_;                 ///< one a node of the frame
  std::vector<Eigen::Vector3d> positions_;  ///< m, likewise; apart from the rest, since all are searched
  std::vector<double> path_;                ///< m driven until each of them
  std::optional<double> last_on_path_;      ///< m, of the last candidate
};

}  // namespace fleetmap::loop_closure
