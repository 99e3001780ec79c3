#include "registration_prior.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/place/descriptor.hpp"
#include "fleetmap/place/proximity_search.hpp"

namespace fleetmap::loop_closure {
namespace {

/// The prior is never taken for better than ICP needs it to be.
constexpr double kMinSigma = 0.1;        // m
constexpr double kMinAngle = 0.01;       // rad
constexpr double kTransformSigma = 1.5;  // m, added to that of an inter-frame transform

/// Errors of the relative pose of two descriptors: it is searched in coarse cells and yaw steps, and the
/// best match may be a few cells off.
constexpr double kMatchSigma = 3.0;        // m
constexpr double kMatchHeightSigma = 0.7;  // m: the ground under both is near
constexpr double kMatchYawSigma = 0.06;    // rad
constexpr double kMatchTiltSigma = 0.02;   // rad

registration::Prior transform_prior(const UncertainPose& T_target_source, const Eigen::Vector3d& up_in_target,
                                    double added_sigma) {
  registration::Prior prior;
  prior.T_target_source = T_target_source.T_a_b;
  const Vector6d variance = T_target_source.covariance.diagonal();
  prior.sigma_translation_m = std::sqrt(variance.head<3>().maxCoeff()) + added_sigma;
  prior.sigma_yaw_rad = std::sqrt(variance(5)) + kMinAngle;
  prior.sigma_tilt_rad = std::sqrt(variance.segment<2>(3).maxCoeff()) + kMinAngle;
  prior.sigma_height_m = std::sqrt(variance.head<3>().maxCoeff()) + kMinSigma;
  prior.up_target = up_in_target;
  return prior;
}

std::optional<registration::Prior> descriptor_prior(const graph::Node& target, const graph::Node& source,
                                                    double min_similarity) {
  const auto of_target = place::Descriptor::decode(target.descriptor);
  const auto of_source = place::Descriptor::decode(source.descriptor);
  if (!of_target || !of_source) return std::nullopt;
  const place::DescriptorMatch match = place::compare(*of_target, *of_source);
  if (!(match.similarity >= min_similarity && match.similarity > 0.0)) return std::nullopt;
  registration::Prior prior;
  prior.T_target_source = place::relative_pose(match, target.up_in_base, source.up_in_base);
  prior.sigma_translation_m = kMatchSigma;
  prior.sigma_yaw_rad = kMatchYawSigma;
  prior.sigma_tilt_rad = kMatchTiltSigma;
  prior.sigma_height_m = kMatchHeightSigma;
  prior.up_target = target.up_in_base;
  return prior;
}

}  // namespace

registration::Prior position_prior(const GlobalPose& target, const GlobalPose& source) {
  const LocalFrame frame(target.position);
  registration::Prior prior;
  prior.T_target_source = pose_in(frame, target).inverse() * pose_in(frame, source);
  const Matrix6d covariance = target.covariance + source.covariance;
  const Eigen::Vector3d rotation = covariance.diagonal().tail<3>();
  // An error of yaw moves the source on a circle around the target.
  const double swing = std::sqrt(rotation.z()) * prior.T_target_source.translation().norm();
  prior.sigma_translation_m = std::sqrt(covariance.diagonal().head<2>().maxCoeff() + swing * swing);
  prior.sigma_yaw_rad = std::sqrt(rotation.z());
  prior.sigma_tilt_rad = std::sqrt(std::max(rotation.x(), rotation.y()));
  const double lift = prior.sigma_tilt_rad * prior.T_target_source.translation().norm();
  prior.sigma_height_m = std::sqrt(covariance(2, 2) + lift * lift);
  prior.up_target = target.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ();
  return prior;
}

std::optional<registration::Prior> registration_prior(const LoopCandidate& candidate,
                                                      const graph::Node& target, const graph::Node& source,
                                                      const CandidateConfig& config) {
  if (candidate.T_target_source) {
    const double added = candidate.origin == LoopCandidate::Origin::kOdometry ? kMinSigma : kTransformSigma;
    return transform_prior(*candidate.T_target_source, target.up_in_base, added);
  }
  if (place::has_known_position(target.G, config.max_sigma_m) &&
      place::has_known_position(source.G, config.max_sigma_m))
    return position_prior(*target.G, *source.G);
  return descriptor_prior(target, source, config.descriptors.min_similarity);
}

}  // namespace fleetmap::loop_closure
