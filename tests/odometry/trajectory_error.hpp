#pragma once

#include <vector>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::testing {

/// Root mean square distance, m, of the positions after the best rigid alignment (Umeyama without scale).
double aligned_rmse(const std::vector<Pose>& estimate, const std::vector<Pose>& truth);

/// Mean over all starts of the position error of the motion over `length` m of path, as a share of it
/// (the KITTI odometry benchmark's translation error). Paths shorter than `length` give the error over all.
double relative_drift(const std::vector<Pose>& estimate, const std::vector<Pose>& truth, double length);

}  // namespace fleetmap::testing
