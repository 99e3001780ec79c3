#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/descriptor_match_config.hpp"
#include "fleetmap/loop_closure/loop_candidate.hpp"
#include "fleetmap/place/descriptor.hpp"

namespace fleetmap::loop_closure {

/// Place recognition: candidates between the nodes of two sides by descriptor match, where G does not
/// determine both positions. A match is supported by others that imply the same transform of the two
/// odometry frames: among repeated rows a single match is often one row off, several in a row are less
/// often.
class DescriptorCandidates {
 public:
  enum class Side : std::uint8_t { kOurs, kTheirs };

  /// `radius` (m): LoopCandidate::radius of the results.
  DescriptorCandidates(const DescriptorMatchConfig& config, double radius)
      : config_(config), radius_(radius) {}

  /// Adds the node and compares it with the nodes of the other side. `located`: G is good enough to find
  /// candidates by; two such nodes are not compared. Returns the best match with each agent of the other side
  /// that is similar enough, with the node of kOurs as the target.
  std::vector<LoopCandidate> propose(const graph::Node& node, bool located, Side side);

 private:
  struct Keyframe {
    NodeId id;
    graph::FrameId frame;
    bool located = false;
    Pose T_odom_base = Pose::Identity();
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    place::Descriptor descriptor;
  };
  struct Match {
    NodeId query;  ///< the node that was added
    NodeId other;
    double similarity = 0.0;
    double distance = 0.0;                             ///< m, between the two
    Pose T_ours_theirs = Pose::Identity();             ///< odometry frames
    Eigen::Vector3d theirs = Eigen::Vector3d::Zero();  ///< the node, in its odometry frame
  };
  using FramePair = std::pair<graph::FrameId, graph::FrameId>;  ///< ours, theirs
  using Track = std::pair<Side, AgentId>;

  struct Keyframes {
    std::vector<Keyframe> all;
    bool any_unlocated = false;
  };
  std::vector<const Keyframe*> comparable(const Keyframe& query, const Track& other) const;
  std::vector<std::pair<FramePair, Match>> compare(const Keyframe& query, const Track& other) const;
  double support_of(const FramePair& frames, const Match& match) const;

  DescriptorMatchConfig config_;
  double radius_;
  std::map<Track, Keyframes> keyframes_;
  std::map<FramePair, std::vector<Match>> matches_;
};

}  // namespace fleetmap::loop_closure
