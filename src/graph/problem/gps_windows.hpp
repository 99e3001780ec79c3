#pragma once

#include <span>
#include <vector>

#include "problem/reduced_graph.hpp"

namespace fleetmap::graph {

/// Nodes [first, end) of a frame, whose fixes are one factor.
struct GpsWindow {
  std::size_t first = 0, end = 0;
  Vector6d variance = Vector6d::Zero();  ///< of G, the mean
  Vector6d before = Vector6d::Zero();    ///< of the window before, zero if there is none
  double seconds = 0.0;                  ///< since that one
  /// Variance of the position without the heading's part: the least variance so far, plus that of dead
  /// reckoning since. Variance above it is caused by the heading, varies along the track, and is independent
  /// of the fixes.
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
};

/// Windows of a frame that hold fixes, and the first of the frame in any case. A window ends after
/// FleetPlacementConfig::window_m of track, half a GPS correlation time, or 16 nodes.
std::vector<GpsWindow> gps_windows(std::span<const Node* const> nodes, const FrameSpan& frame,
                                   const FleetPlacementConfig& config);

/// `variable`, the pose variable at the window's first node, with the window's fixes as one factor. `windows`
/// is their number in the frame.
PoseVariable with_window(PoseVariable variable, std::span<const Node* const> nodes, const GpsWindow& window,
                         std::size_t windows, const LocalFrame& site, const FleetPlacementConfig& config);

/// Correlation of the drifts of two consecutive windows, axis by axis.
Eigen::Vector3d drift_correlation(const PoseVariable& a, const PoseVariable& b, double seconds,
                                  const FleetPlacementConfig& config);

}  // namespace fleetmap::graph
