#pragma once

#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::registration {

/// Test by which ICP detects that a point and a surfel lie on opposite sides of an object, so that its
/// thickness separates them.
enum class SideTest {
  surface_normals,   ///< planes whose normals, turned to the sensors, face apart
  sensor_positions,  ///< planes and posts between the two sensors: one sensor observed the other's far side
};

/// Alignment of points to surfels.
struct IcpConfig {
  /// m, widths of the robust kernel (Geman-McClure), one stage each. The first stages search for surfels
  /// farther away.
  std::vector<float> kernels_m{0.5f, 0.25f, 0.1f, 0.06f};
  std::size_t far_stages = 2;
  int iterations_per_stage = 6;
  SideTest side_test = SideTest::surface_normals;  ///< from the first stage on that is not far
  float min_normal_agreement = 0.7f;               ///< |cos| between normals, where both sides have one
  double converged_m = 1e-3;    ///< m, a smaller step ends the stage (a tenth of it the last one)
  double converged_rad = 1e-4;  ///< rad
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

}  // namespace fleetmap::registration
