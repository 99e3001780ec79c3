#pragma once

#include <span>

#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

struct FleetPlacementConfig {
  double gps_correlation_time = 60.0;  ///< s, of the slowly drifting part of G's error
  double gps_drift_share = 0.9;        ///< of the variance of G's position that drifts, (0, 1)
  double window_m = 30.0;              ///< m of path whose fixes count as one
  double alignment_floor_m = 0.01;  ///< m, added in squares to C_ij: what registration cannot know of itself
  double alignment_floor_rad = 0.001;  ///< rad, likewise
  Status validate() const;
};

/// The fleet's robust pose graph (method `graph`): odometry between the nodes of a frame, G of every node
/// with an error that drifts slowly (a Gauss-Markov process for each robot), and those alignments, each in at
/// most one of its modes, that agree with GPS, odometry and each other. Alignments that do not are rejected,
/// and so are all of an agent that mostly computes such (quarantine).
///
/// A function of the set alone, bit for bit: items are sorted first, and nothing is kept from call to call.
/// Items with non-finite or impossible numbers do not count. The covariance of the nodes in `covariance_of`
/// is computed as well.
Placement place_by_fleet_graph(std::span<const Node> nodes, std::span<const Alignment> alignments,
                               const LocalFrame& site, const FleetPlacementConfig& config = {},
                               std::span<const NodeId> covariance_of = {});

}  // namespace fleetmap::graph
