#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/cloud/normals.hpp"
#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/registration/fpfh.hpp"
#include "fleetmap/registration/icp.hpp"
#include "fleetmap/registration/prior.hpp"
#include "fleetmap/registration/ransac.hpp"

namespace fleetmap::registration {

struct RegistrationConfig {
  float voxel_m = 0.3f;                   ///< m, both clouds are thinned to it first
  float feature_voxel_m = 0.6f;           ///< m, features are computed on clouds thinned to this,
  std::size_t max_feature_points = 6000;  ///< or coarser, so that no more points than this are left
  float feature_radius_m = 3.0f;          ///< m, neighbourhood of a feature
  cloud::NormalConfig normals{12, 1.5f, 5, Eigen::Vector3f::Zero()};          ///< of the thinned clouds
  cloud::NormalConfig feature_normals{16, 2.0f, 5, Eigen::Vector3f::Zero()};  ///< for features
  MatchConfig matching;
  RansacConfig ransac;
  IcpConfig icp;
  std::size_t max_icp_points = 4000;    ///< source points used in ICP and scoring, evenly picked
  std::size_t max_coarse_points = 800;  ///< source points used to compare modes
  std::size_t max_modes = 4;            ///< compared after a coarse ICP; besides the prior
  double contender_share = 0.5;         ///< modes that then score this share of the best are refined as well
  float inlier_m = 0.5f;   ///< m, a source point with a target point this close is an inlier (Eq. 2)
  float overlap_m = 1.5f;  ///< m, a source point with a target point this close lies in the overlap

  std::size_t min_points = 100;  ///< of each cloud after thinning
  std::size_t min_inliers = 100;
  double min_inlier_fraction = 0.15;  ///< inliers over source points
  /// Score over overlap, [0, 1]: wrong poses in cluttered scenes reach 0.38, right ones with half of each
  /// ball in common 0.45 and more.
  double min_agreement = 0.42;
  double max_rmse_m = 0.4;       ///< m, E_ij of a good alignment (paper)
  double ambiguous_share = 0.9;  ///< a second mode scoring this share of the best makes the result ambiguous
  Status validate() const;
};

enum class Verdict { accepted, ambiguous, rejected };
const char* to_string(Verdict verdict);

/// One way in which the clouds fit.
struct Mode {
  Pose T_target_source = Pose::Identity();
  double score =
      0.0;  ///< [0, 1]: mean over source points of max(0, 1 - (distance / inlier_m)^2), normals agreeing
  double rmse = 0.0;  ///< m, as in RegistrationResult
  double inlier_fraction = 0.0;
  double overlap = 0.0;
  bool from_prior = false;  ///< found from the prior rather than from features
};

struct RegistrationResult {
  Pose T_target_source = Pose::Identity();  ///< of the best mode
  /// E_ij (Eq. 2), m: root mean square distance from each inlier (source point, moved by T_target_source) to
  /// its nearest target point. Inliers are those nearer than inlier_m whose normals do not contradict. Both
  /// clouds thinned to voxel_m.
  double rmse = 0.0;
  /// C_ij: inverse Fisher information of the point-to-plane residuals, with their estimated noise, right
  /// tangent of T_target_source: [m, rad]. Large, but finite, along what the scene does not constrain.
  Matrix6d covariance = Matrix6d::Identity();
  double inlier_fraction = 0.0;  ///< inliers over source points, [0, 1]
  double overlap = 0.0;          ///< source points in the overlap over source points, [0, 1]
  double agreement =
      0.0;  ///< score over overlap: how well the points agree where both clouds have any, [0, 1]
  std::size_t inliers = 0;  ///< among the source points scored
  std::size_t scored = 0;   ///< source points scored
  Verdict verdict = Verdict::rejected;
  std::string reason;       ///< for people: why rejected or ambiguous; empty when accepted
  std::vector<Mode> modes;  ///< best score first
  std::size_t correspondences = 0;
};

/// T_target_source from the points alone, or with a prior: FPFH, mutual matching and RANSAC give hypotheses,
/// the prior itself is one more, point-to-plane ICP refines the best of them, and the one that fits best wins
/// (paper, spherized registration). Each cloud should be in the frame of its own sensor path, roughly
/// gravity-up if a prior is given. Deterministic. Non-finite points are left out; clouds too small to tell
/// are rejected.
RegistrationResult register_clouds(const cloud::PointCloud& target, const cloud::PointCloud& source,
                                   const RegistrationConfig& config,
                                   const std::optional<Prior>& prior = std::nullopt);

}  // namespace fleetmap::registration
