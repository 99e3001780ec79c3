#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/registration/map_drift.hpp"
#include "fleetmap/registration/prepared_cloud.hpp"
#include "fleetmap/registration/prior.hpp"
#include "fleetmap/registration/registration_config.hpp"

namespace fleetmap::registration {

/// Use of a registration: accepted, one of several possible poses, or rejected.
enum class Verdict { accepted, ambiguous, rejected };
const char* to_string(Verdict verdict);

/// A pose at which the clouds fit.
struct Mode {
  Pose T_target_source = Pose::Identity();
  /// [0, 1]: one less the mean misfit d^2 / (d^2 + misfit_m^2) of the points of both clouds that lie where
  /// the other cloud's robot saw something.
  double score = 0.0;
  double rmse = 0.0;                           ///< m, as in RegistrationResult
  double inlier_fraction = 0.0;                ///< as in RegistrationResult
  double overlap = 0.0;                        ///< as in RegistrationResult
  Matrix6d covariance = Matrix6d::Identity();  ///< as in RegistrationResult
  /// Probability of this mode among the modes, from the points and the prior.
  double weight = 0.0;
  std::size_t inliers = 0;
};

/// T_ij, E_ij and C_ij of the paper (Eq. 2), with all poses at which the clouds fit.
struct RegistrationResult {
  Pose T_target_source = Pose::Identity();  ///< of the first mode
  /// E_ij (Eq. 2), m: root mean square distance from each inlier (source point, moved by T_target_source) to
  /// the target's surface next to it. Inliers are those nearer than inlier_m whose normals do not contradict.
  double rmse = 0.0;
  /// C_ij, right tangent of T_target_source: [m, rad]. Large, but finite, along what the scene does not
  /// constrain.
  Matrix6d covariance = Matrix6d::Identity();
  double inlier_fraction = 0.0;  ///< inliers over source points, [0, 1]
  double overlap = 0.0;          ///< source points where the target's robot saw something over source points
  double agreement = 0.0;        ///< share of inliers among the points above the floor
  /// rmse over that of each cloud against itself (noise, rounding, roughness), both together.
  double excess = 0.0;
  std::size_t inliers = 0;  ///< among the source points scored
  std::size_t scored = 0;   ///< source points scored
  Verdict verdict = Verdict::rejected;
  std::string reason;       ///< for people: why rejected or ambiguous; empty when accepted
  std::vector<Mode> modes;  ///< most weight first; those of next to no weight are left out
};

/// Spherized registration (paper, Alg. 3) by config.method:
///
/// - `correlation` returns all poses T_target_source that fit, and whether one of them is certain. The maps
///   of both clouds are correlated over every pose of the prior's window (without a prior, over all poses in
///   reach), after Olson, "Real-time correlative scan matching", ICRA 2009; point-to-surfel ICP refines the
///   candidates; the misfits of all patches of ground and the prior weight the resulting modes. `drifts` are
///   propagated into the covariances.
///
/// - `paper` returns the one pose of RANSAC over FPFH correspondences and point-to-plane ICP. It uses
///   neither prior nor drifts.
///
/// Deterministic. Both clouds must be level within some 0.15 rad, after the prior's tilt if there is one.
/// Non-finite points are left out; clouds with too few points are rejected.
RegistrationResult register_clouds(const cloud::PointCloud& target, const cloud::PointCloud& source,
                                   const RegistrationConfig& config,
                                   const std::optional<Prior>& prior = std::nullopt,
                                   const Drifts& drifts = {});

/// The same for clouds prepared with the same `config`.
RegistrationResult register_clouds(const PreparedCloud& target, const PreparedCloud& source,
                                   const RegistrationConfig& config,
                                   const std::optional<Prior>& prior = std::nullopt,
                                   const Drifts& drifts = {});

}  // namespace fleetmap::registration
