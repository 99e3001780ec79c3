#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "draws.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/store.hpp"
#include "synthetic_survey.hpp"

namespace fleetmap::fault_injection {

/// False items of a member whose keys are valid and whose program was changed. One scheme follows from the
/// seed, so that all its items serve one aim.
class CompromisedRobot {
 public:
  enum class Scheme : std::uint8_t {
    kGarbage,  ///< own nodes and alignments metres to hundreds of metres off, covariances of any size
    kTear,     ///< own fixes uncertain, clouds displaced differently for each peer: pulls peers apart
    kPull,     ///< own fixes certain, clouds displaced alike for all peers: pulls the fleet along
    kStretch,  ///< own odometry too long and certain, alignments true
  };
  static constexpr std::size_t kSchemes = 4;

  CompromisedRobot(std::uint64_t seed, const AgentId& self);

  const AgentId& self() const { return self_; }
  Scheme scheme() const { return scheme_; }

  /// The node that it makes instead of `node`.
  graph::Node falsified(const graph::Node& node, const LocalFrame& site);
  /// The result of a registration of which one cloud is its own, whoever computes it. Small covariance.
  graph::Alignment falsified(graph::Alignment alignment, const SyntheticSurvey& survey);
  /// An alignment of an own node with a near node of another robot, which no registration gave. None: the
  /// store holds no such pair.
  std::optional<graph::Alignment> invented(const store::Store& store, const SyntheticSurvey& survey,
                                           std::uint32_t seq);
  /// An encoded cloud that claims four million points in a few bytes.
  static Bytes oversize_cloud();
  /// Its odometry jumps as that of no honest robot does.
  bool is_gross() const;
  /// An alignment of nodes of two other robots, of a session of its own.
  std::optional<graph::Alignment> of_others(const store::Store& store, const SyntheticSurvey& survey);

 private:
  /// Displacement in ENU of its clouds against the map of `peer`.
  Pose displacement(const AgentId& peer);
  Pose random_displacement(double min_length, double max_length);

  Draws draws_;
  AgentId self_;
  Scheme scheme_;
  std::map<AgentId, Pose> displacements_;
  std::optional<Pose> T_odom_last_;  ///< of its last false node
  std::size_t jumps_ = 0;            ///< of its false odometry
  std::uint32_t next_of_others_;
};

const char* to_string(CompromisedRobot::Scheme scheme);

}  // namespace fleetmap::fault_injection
