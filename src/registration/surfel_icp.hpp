#pragma once

#include <cstdint>
#include <vector>

#include "drift_model.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/registration/icp_config.hpp"
#include "surfels.hpp"

namespace fleetmap::registration {

/// Orientation of the surface at a point.
struct Facing {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float side = 0.0f;    ///< as in Surfel
  bool planar = false;  ///< there is a normal
};

/// Moving points with their surface data. `facing` may be empty; `patches` (index of the square that a point
/// lies in) too, if no covariance is needed.
struct MovingPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<Facing> facing;
  std::vector<std::uint16_t> patches;
  std::vector<std::uint8_t> above_floor;  ///< 1 for points above the floor
  std::size_t patch_count = 0;            ///< a square of squares around the origin, row by row
  float patch_m = 4.0f;                   ///< m, edge of one
};

/// Models of the drift of the odometry, which deforms both clouds.
struct DriftModels {
  DriftModel target, source;
};

struct IcpResult {
  Pose T_target_source = Pose::Identity();
  bool converged = false;  ///< the last step was below the limits
  int iterations = 0;
  int unconstrained = 0;  ///< directions (of 6) that nothing constrains, as at the end
  /// Covariance of T_target_source, right tangent: [m, rad]. Residuals of one patch of ground may share an
  /// error, those of different patches do not (cluster-robust sandwich estimator, Liang and Zeger 1986); the
  /// drift of both maps is added. Large, but finite, along directions that the scene does not constrain.
  Matrix6d covariance = Matrix6d::Identity();
};

/// Point-to-surfel ICP from `T_initial`: Gauss-Newton on SE(3), T <- T exp(xi), on point-to-plane distances
/// (Chen and Medioni 1992) with weights of Geman and McClure (1985). With a covariance if `drift_models` are
/// present.
IcpResult align(const SurfelMap& target, const MovingPoints& source, const Pose& T_initial,
                const IcpConfig& config, const DriftModels* drift_models = nullptr);

}  // namespace fleetmap::registration
