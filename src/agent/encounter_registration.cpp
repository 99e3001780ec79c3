#include "fleetmap/agent/encounter_registration.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/place/descriptor.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::agent {
namespace {

/// A start is not better than ICP needs it to be.
constexpr double kLeastPriorSigma = 0.1;   // m
constexpr double kLeastPriorAngle = 0.01;  // rad
constexpr double kTiedPriorSigma = 1.5;    // m

/// Where the descriptors alone tell how two nodes lie: cells and turns are tried in coarse steps, and what
/// looks most alike may be a few cells off.
constexpr double kAlikeSigma = 3.0;        // m
constexpr double kAlikeHeightSigma = 0.7;  // m: the ground under both is near
constexpr double kAlikeYawSigma = 0.06;    // rad
constexpr double kAlikeTiltSigma = 0.02;   // rad

/// Modes of an ambiguous registration of at least this weight are alternatives to the best: what is less
/// likely than one in a thousand does not keep a registration from being accepted either.
constexpr double kAlternativeWeight = 1e-3;

/// Nodes farther apart than this see what stands between them from its two sides. Posts and tables are some
/// centimetres thick, and their fronts come to lie on their backs: 42 m apart all alignments of two lanes of
/// a farm lay 7 cm too near, with a scatter of 2 cm. So many that err alike (30 of two lanes) count as one.
constexpr double kTwoSidesFrom = 30.0;  // m
constexpr double kTwoSidesSigma = 0.3;  // m, horizontally

Matrix6d covariance_of(const Pose& T_i_j, const Matrix6d& registered) {
  Matrix6d covariance = registered;
  if (T_i_j.translation().norm() > kTwoSidesFrom)
    covariance.diagonal().head<2>().array() += kTwoSidesSigma * kTwoSidesSigma;
  return covariance;
}

registration::Prior prior_of(const UncertainPose& T_target_source, const Eigen::Vector3d& up_in_target,
                             double least_sigma) {
  registration::Prior prior;
  prior.T_target_source = T_target_source.T_a_b;
  const Vector6d variance = T_target_source.covariance.diagonal();
  prior.sigma_translation_m = std::sqrt(variance.head<3>().maxCoeff()) + least_sigma;
  prior.sigma_yaw_rad = std::sqrt(variance(5)) + kLeastPriorAngle;
  prior.sigma_tilt_rad = std::sqrt(variance.segment<2>(3).maxCoeff()) + kLeastPriorAngle;
  prior.sigma_height_m = std::sqrt(variance.head<3>().maxCoeff()) + kLeastPriorSigma;
  prior.up_target = up_in_target;
  return prior;
}

}  // namespace

registration::Prior prior_of(const GlobalPose& target, const GlobalPose& source) {
  const LocalFrame frame(target.position);
  registration::Prior prior;
  prior.T_target_source = pose_in(frame, target).inverse() * pose_in(frame, source);
  const Matrix6d covariance = target.covariance + source.covariance;
  const Eigen::Vector3d rotation = covariance.diagonal().tail<3>();
  // Yaw moves the other node on a circle around ours: its error is one of position too.
  const double swing = std::sqrt(rotation.z()) * prior.T_target_source.translation().norm();
  prior.sigma_translation_m = std::sqrt(covariance.diagonal().head<2>().maxCoeff() + swing * swing);
  prior.sigma_yaw_rad = std::sqrt(rotation.z());
  prior.sigma_tilt_rad = std::sqrt(std::max(rotation.x(), rotation.y()));
  const double lift = prior.sigma_tilt_rad * prior.T_target_source.translation().norm();
  prior.sigma_height_m = std::sqrt(covariance(2, 2) + lift * lift);
  prior.up_target = target.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ();
  return prior;
}

std::optional<registration::Prior> prior_of(const graph::Node& target, const graph::Node& source,
                                            const exchange::EncounterConfig& config) {
  if (place::tells_place(target.G, config.max_sigma_m) && place::tells_place(source.G, config.max_sigma_m))
    return prior_of(*target.G, *source.G);
  const auto looks = place::Descriptor::decode(target.descriptor);
  const auto other = place::Descriptor::decode(source.descriptor);
  if (!looks || !other) return std::nullopt;
  const place::Likeness likeness = place::compare(*looks, *other);
  if (!(likeness.similarity >= config.lookalikes.min_similarity && likeness.similarity > 0.0))
    return std::nullopt;
  registration::Prior prior;
  prior.T_target_source = place::relative_pose(likeness, target.up_in_base, source.up_in_base);
  prior.sigma_translation_m = kAlikeSigma;
  prior.sigma_yaw_rad = kAlikeYawSigma;
  prior.sigma_tilt_rad = kAlikeTiltSigma;
  prior.sigma_height_m = kAlikeHeightSigma;
  prior.up_target = target.up_in_base;
  return prior;
}

registration::Prior prior_of(const LoopClosure& closure) {
  const Pose T_target_source = closure.earlier.T_odom_base.inverse() * closure.later.T_odom_base;
  return prior_of({T_target_source, closure.covariance}, closure.earlier.up_in_base, kLeastPriorSigma);
}

registration::Prior prior_of(const UncertainPose& T_target_source, const Eigen::Vector3d& up_in_target) {
  return prior_of(T_target_source, up_in_target, kTiedPriorSigma);
}

graph::Alignment alignment_of(const NodeId& i, const NodeId& j, const AgentId& computed_by,
                              const registration::RegistrationResult& result) {
  graph::Alignment alignment{i, j, computed_by, 0, {}};
  if (result.verdict != registration::Verdict::ambiguous) {
    const double score = result.modes.empty() ? result.agreement : result.modes.front().score;
    alignment.modes = {{result.T_target_source, result.rmse, result.inlier_fraction, score,
                        covariance_of(result.T_target_source, result.covariance)}};
    return alignment;
  }
  for (const registration::Mode& mode : result.modes) {
    if (alignment.modes.size() == graph::Alignment::kMaxModes) break;
    // Most weight first. The second stays in any case: with one mode alone the alignment would pass for
    // certain.
    if (alignment.modes.size() > 1 && mode.weight < kAlternativeWeight) break;
    alignment.modes.push_back({mode.T_target_source, mode.rmse, mode.inlier_fraction, mode.score,
                               covariance_of(mode.T_target_source, mode.covariance)});
  }
  return alignment;
}

}  // namespace fleetmap::agent
