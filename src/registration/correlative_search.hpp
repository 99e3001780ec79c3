#pragma once

#include <vector>

#include "correlation_grid.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::registration {

/// The search window: T_target_source between levelled frames.
struct CorrelationWindow {
  Eigen::Vector2f center = Eigen::Vector2f::Zero();
  float radius_m = 20.0f;     ///< m
  float yaw_center = 0.0f;    ///< rad
  float yaw_half = 3.2f;      ///< rad, of the window; more than pi is all around
  float yaw_step = 0.022f;    ///< rad
  double min_overlap = 0.25;  ///< share of the source's cells that lie where the target saw anything
  std::size_t max_candidates = 100;
};

struct CorrelationCandidate {
  Eigen::Vector2f xy = Eigen::Vector2f::Zero();
  float yaw = 0.0f;
  float height = 0.0f;                              ///< m, of the source's origin over the target's
  Eigen::Vector2f slope = Eigen::Vector2f::Zero();  ///< by how much it rises towards the target's x and y
  double agreement = 0.0;                           ///< [0, 1] of the cells in the overlap
  double overlap = 0.0;                             ///< [0, 1]
};

/// Scores every pose of the window, to the map's cell and the yaw's step, by correlation (Olson, "Real-time
/// correlative scan matching", ICRA 2009). Returns local maxima, best first.
std::vector<CorrelationCandidate> correlative_search(const CorrelationGrid& target,
                                                     const CorrelationGrid& source,
                                                     const CorrelationWindow& window);

}  // namespace fleetmap::registration
