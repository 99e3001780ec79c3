#pragma once

#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::registration {

/// What tells that a point and a surfel are of opposite sides of a thing, which its thickness sets apart.
enum class Sides {
  of_normals,  ///< planes whose normals, turned to the sensors, face apart
  of_sensors,  ///< planes and posts between the two sensors: the point's was behind what the target's saw
};

/// Alignment of points to surfels.
struct IcpConfig {
  /// m, widths of the robust kernel (Geman-McClure), one stage each. The first stages look for surfels
  /// farther off.
  std::vector<float> kernels_m{0.5f, 0.25f, 0.1f, 0.06f};
  std::size_t far_stages = 2;
  int iterations_per_stage = 6;
  Sides sides = Sides::of_normals;    ///< from the first stage on that is not far
  float min_normal_agreement = 0.7f;  ///< |cos| between normals, where both sides have one
  double converged_m = 1e-3;          ///< m, a smaller step ends the stage (a tenth of it the last one)
  double converged_rad = 1e-4;        ///< rad
  /// An eigenvalue of the information (in units of its largest, rotation scaled to m) below this is no
  /// constraint: no step is taken along it.
  double degenerate_share = 1e-4;
  double max_stddev_m = 10.0;  ///< m, covariance along a direction that nothing constrains
  /// Floors of the covariance: what neither residuals nor the drift of the maps show (voxels, rounding, posts
  /// seen from both sides).
  double min_stddev_m = 0.005;     ///< m, along every direction
  double min_stddev_rad = 0.0002;  ///< rad, about every axis
  Status validate() const;
};

struct IcpResult {
  Pose T_target_source = Pose::Identity();
  bool converged = false;  ///< the last step was below the limits
  int iterations = 0;
  int unconstrained = 0;  ///< directions (of 6) that nothing constrains, as at the end
  /// Of T_target_source, right tangent: [m, rad]. Residuals of one patch of ground may share an error, those
  /// of different patches not (the cluster-robust sandwich estimator); to which comes what the drift of both
  /// maps does. Large, but finite, along what the scene does not constrain.
  Matrix6d covariance = Matrix6d::Identity();
};

}  // namespace fleetmap::registration
