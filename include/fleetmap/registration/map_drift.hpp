#pragma once

#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::registration {

/// A place that a robot passed while it made the map of a cloud.
struct MapStop {
  Pose T_cloud_base = Pose::Identity();
  /// Covariance of the odometry since the stop before: right tangent of T_before_this, [m, rad]. Without
  /// meaning for the first stop.
  Matrix6d step_covariance = Matrix6d::Zero();
};

/// Uncertainty of the inner shape of a cloud: the stops from which its points were seen, in the robot's
/// order, and the covariance of the odometry from each stop to the next. The cloud's frame is fixed to the
/// stop nearest to its origin. Without stops, straight() is assumed.
struct MapDrift {
  std::vector<MapStop> stops;

  /// Odometry that errs by `sigma_m` along and `sigma_rad` about every axis a root metre, on a straight path
  /// along the cloud's x axis, `reach_m` to both sides. The defaults are those of a LiDAR odometry of 0.13 %
  /// over 20 m.
  static MapDrift straight(double sigma_m = 0.006, double sigma_rad = 0.0004, double reach_m = 40.0);
  Status validate() const;
};

/// Drifts of both clouds of a registration.
struct Drifts {
  MapDrift target, source;
};

}  // namespace fleetmap::registration
