#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/signature.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::graph {

/// A relative pose at which the clouds of two nodes fit.
struct AlignmentMode {
  Pose T_i_j = Pose::Identity();  ///< maps base_link of node j into base_link of node i
  double rmse = 0.0;              ///< E_ij, inlier RMSE in m (Eq. 2)
  double inlier_fraction = 0.0;   ///< inliers over source points, [0, 1]
  double score = 0.0;             ///< how well the clouds agree, [0, 1]; compares modes of one alignment
  Matrix6d covariance =
      Matrix6d::Identity();  ///< C_ij, inverse Fisher information, right tangent of T_i_j: [m, rad]
};

/// Result of registering the spherized clouds of two nodes (Alg. 3 and Eq. 2 of the paper). In a scene that
/// repeats itself several relative poses may fit; the alignment then holds all of them as alternatives, of
/// which at most one is right, and the fleet graph decides by their consistency with other alignments. The
/// nodes may be of one agent, and of one odometry frame (a loop closure). Immutable.
struct Alignment {
  static constexpr std::size_t kMaxModes = 6;

  NodeId i;             ///< target node
  NodeId j;             ///< source node
  AgentId computed_by;  ///< the agent that ran the registration: one of the two
  std::uint32_t seq =
      0;  ///< the seq-th alignment of `computed_by`, from 0 without gaps: (computed_by, seq) names it
  std::vector<AlignmentMode> modes{AlignmentMode{}};  ///< 1 to kMaxModes, best first
  std::optional<Signature> signature{};  ///< of `computed_by`, over all the rest; none without keys

  const AlignmentMode& best() const { return modes.front(); }
  /// True if the registration could not decide between several modes.
  bool ambiguous() const { return modes.size() > 1; }
};

/// An alignment counts as good when E_ij is at most this (paper).
inline constexpr double kGoodRmse = 0.4;  ///< m

}  // namespace fleetmap::graph
