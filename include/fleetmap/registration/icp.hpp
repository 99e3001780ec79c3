#pragma once

#include <cstddef>
#include <vector>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::registration {

struct IcpConfig {
  std::vector<float> max_distances_m{2.0f, 1.0f,
                                     0.5f};  ///< m, of correspondences: coarse to fine, one stage each
  int iterations_per_stage = 8;
  float kernel_share = 0.25f;  ///< width of the robust kernel (Geman-McClure) over the stage's max distance
  float min_normal_agreement = 0.5f;  ///< |cos| between the normals of a correspondence, where both have one
  double converged_m = 1e-3;          ///< m, a smaller step ends the stage (1e-4 m in the last)
  double converged_rad = 1e-4;        ///< rad
  /// An eigenvalue of the information (in units of its largest, rotation scaled to m) below this is no
  /// constraint: no step is taken along it.
  double degenerate_share = 1e-4;
  /// m: residuals of points in one cube of this edge count as one measurement, since they share surface and
  /// normals.
  float correlation_m = 1.0f;
  double max_stddev_m = 10.0;  ///< m, covariance along a direction that nothing constrains
  double min_noise_m = 0.02;   ///< m, floor of the estimated noise of a point-to-plane residual
  Status validate() const;
};

/// The cloud that others are registered to.
struct IcpTarget {
  const cloud::PointCloud& cloud;
  const cloud::KdTree& tree;
  const cloud::Normals& normals;
};
/// The cloud that moves; `normals` may be empty.
struct IcpSource {
  const cloud::PointCloud& cloud;
  const cloud::Normals& normals;
};

struct IcpResult {
  Pose T_target_source = Pose::Identity();
  bool converged = false;  ///< the last step was below the limits
  int iterations = 0;
  int unconstrained = 0;  ///< directions (of 6) that nothing constrains, as at the end
  /// Inverse Fisher information of the last linearisation, right tangent of T_target_source: [m, rad].
  Matrix6d covariance = Matrix6d::Identity();
};

/// Point-to-plane ICP from `T_initial`: Gauss-Newton on SE(3), T <- T exp(xi), Geman-McClure weights. Source
/// points must be finite.
IcpResult icp(const IcpTarget& target, const IcpSource& source, const Pose& T_initial,
              const IcpConfig& config);

}  // namespace fleetmap::registration
