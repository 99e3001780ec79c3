#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph {

/// Status of an alignment in the placement.
enum class AlignmentStatus {
  used,
  against_gps,     ///< contradicts GPS and odometry
  against_others,  ///< contradicts alignments that are better supported
  undecided,       ///< too little evidence for it, or for it rather than another
  quarantined,     ///< of an agent that mostly computes false ones
  waiting,         ///< its nodes have not arrived yet
  invalid,         ///< has impossible numbers
};
const char* to_string(AlignmentStatus status);

/// Status of one alignment after the placement.
struct AlignmentOutcome {
  NodeId i, j;
  AgentId computed_by;
  std::uint32_t seq = 0;
  AlignmentStatus status = AlignmentStatus::undecided;
  std::size_t mode = 0;  ///< that is used
};

/// Counts of the alignments that an agent computed, by their status.
struct AlignmentStats {
  std::size_t used = 0;
  std::size_t rejected = 0;      ///< contradict GPS, odometry or others
  std::size_t outlier_sets = 0;  ///< sets of rejected alignments that agree with each other
  bool quarantined = false;
};

/// Pose of every node in the site's ENU frame. A function of the set of nodes and alignments alone, so
/// agents that hold the same set hold the same placement, bit for bit, in whatever order the items arrived.
struct Placement {
  std::map<NodeId, Pose> T_enu_node;
  std::map<FrameId, Pose> T_enu_odom;
  /// Odometry frames that alignments connect; each component is placed by its nodes' GPS.
  std::vector<std::vector<FrameId>> components;
  /// The alignments that connect them, each with its accepted mode alone.
  std::vector<Alignment> used;

  // Only of method `graph`.
  std::vector<AlignmentOutcome> outcomes;  ///< every alignment, by (computed_by, seq)
  std::optional<AgentId> contradicting;  ///< agent that contradicts all others: no alignment with it is used
  std::map<AgentId, AlignmentStats> alignment_stats;  ///< of those who computed any
  std::map<NodeId, Matrix6d> covariance;              ///< of T_enu_node, right tangent: [m, rad]
};

}  // namespace fleetmap::graph
