#include "fleetmap/registration/register_clouds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fleetmap/geometry/rotated_covariance.hpp"
#include "modes.hpp"
#include "prepared_data.hpp"

namespace fleetmap::registration {
namespace {

/// Modes of less weight are not handed over.
constexpr double kMinWeight = 1e-6;
/// m; a pose less certain than this is accepted only if nearly everything agrees (a corridor).
constexpr double kMaxStddev = 0.5;
constexpr double kPlainAgreement = 0.8;

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

Mode mode_of(const FoundMode& found, const PreparedCloud::Data& target, const PreparedCloud::Data& source) {
  Mode mode;
  mode.T_target_source = make_pose(
      Eigen::Matrix3d(target.R_level_cloud.transpose() * found.T_level.linear() * source.R_level_cloud),
      Eigen::Vector3d(target.R_level_cloud.transpose() * found.T_level.translation()));
  // The right tangent lives in the source's frame.
  mode.covariance = rotated(found.icp.covariance, source.R_level_cloud.transpose());
  mode.covariance = Matrix6d(0.5 * (mode.covariance + mode.covariance.transpose()));
  const auto scored = static_cast<double>(std::max<std::size_t>(1, found.fit.scored));
  mode.score = found.fit.score;
  mode.rmse = found.fit.rmse;
  mode.inlier_fraction = static_cast<double>(found.fit.inliers) / scored;
  mode.overlap = static_cast<double>(found.fit.overlapping) / scored;
  mode.inliers = found.fit.inliers;
  mode.weight = found.weight;
  return mode;
}

/// Sets verdict and reason from the numbers already in `result`.
void set_verdict(RegistrationResult& result, const RegistrationConfig& config) {
  result.verdict = Verdict::rejected;
  const bool degenerate = result.covariance.diagonal().head<3>().maxCoeff() > kMaxStddev * kMaxStddev &&
                          result.agreement < kPlainAgreement;
  if (result.inliers < config.min_inliers) {
    result.reason = text("only %zu inliers, at least %zu are needed", result.inliers, config.min_inliers);
  } else if (result.inlier_fraction < config.min_inlier_fraction) {
    result.reason = text(
        "only %.2f of the source points are inliers, at least %.2f are needed: the clouds overlap too little",
        result.inlier_fraction, config.min_inlier_fraction);
  } else if (result.agreement < config.min_agreement) {
    result.reason =
        text("where the clouds overlap %.2f of what stands out of the floor agrees, at least %.2f are needed",
             result.agreement, config.min_agreement);
  } else if (result.rmse > config.max_rmse_m) {
    result.reason = text("inlier RMSE is %.2f m, at most %.2f m is good", result.rmse, config.max_rmse_m);
  } else if (result.excess > config.max_excess) {
    result.reason =
        text("inlier RMSE is %.2f times what the clouds' own noise explains, at most %.2f is good",
             result.excess, config.max_excess);
  } else if (degenerate) {
    result.reason = "the scene leaves the pose open along some direction";
  } else if (result.modes.front().weight < config.min_weight) {
    result.verdict = Verdict::ambiguous;
    const Eigen::Vector3d apart =
        result.modes[1].T_target_source.translation() - result.modes[0].T_target_source.translation();
    result.reason = text("%zu poses fit; the likeliest has a weight of %.3f, the next, %.1f m away, %.3f",
                         result.modes.size(), result.modes[0].weight, apart.norm(), result.modes[1].weight);
  } else {
    result.verdict = Verdict::accepted;
  }
}

RegistrationResult rejected(std::string reason) {
  RegistrationResult result;
  result.reason = std::move(reason);
  return result;
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::accepted:
      return "accepted";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::rejected:
      return "rejected";
  }
  return "?";
}

RegistrationResult register_clouds(const PreparedCloud& target, const PreparedCloud& source,
                                   const RegistrationConfig& config, const std::optional<Prior>& prior,
                                   const Drifts& drifts) {
  if (auto valid = config.validate(); !valid) return rejected(valid.error().message);
  if (prior) {
    if (auto valid = prior->validate(); !valid) return rejected(valid.error().message);
  }
  for (const MapDrift* drift : {&drifts.target, &drifts.source}) {
    if (auto valid = drift->validate(); !valid) return rejected(valid.error().message);
  }
  if (target.data() == nullptr || source.data() == nullptr) return rejected("a cloud was not prepared");
  if (config.method == Method::paper)
    return register_by_features(target.data()->features, source.data()->features, config.paper);
  const std::size_t fewest = std::min(target.size(), source.size());
  if (fewest < config.min_points) {
    return rejected(text("a cloud has only %zu points after thinning, at least %zu are needed", fewest,
                         config.min_points));
  }
  const std::vector<FoundMode> modes = find_modes(*target.data(), *source.data(), config, prior, drifts);
  if (modes.empty()) {
    return rejected("the clouds fit at no pose" + std::string(prior ? " within the prior" : ""));
  }
  RegistrationResult result;
  for (const FoundMode& found : modes) {
    if (found.weight >= kMinWeight) result.modes.push_back(mode_of(found, *target.data(), *source.data()));
  }
  const Mode& best = result.modes.front();
  result.T_target_source = best.T_target_source;
  result.rmse = best.rmse;
  result.covariance = best.covariance;
  result.inlier_fraction = best.inlier_fraction;
  result.overlap = best.overlap;
  result.agreement = modes.front().fit.agreement;
  const double noise = std::hypot(target.data()->noise_m, source.data()->noise_m);
  result.excess = noise > 0.0 ? best.rmse / noise : 0.0;
  result.inliers = best.inliers;
  result.scored = modes.front().fit.scored;
  set_verdict(result, config);
  return result;
}

RegistrationResult register_clouds(const cloud::PointCloud& target, const cloud::PointCloud& source,
                                   const RegistrationConfig& config, const std::optional<Prior>& prior,
                                   const Drifts& drifts) {
  if (auto valid = config.validate(); !valid) return rejected(valid.error().message);
  Eigen::Vector3d up_target = Eigen::Vector3d::UnitZ(), up_source = up_target;
  if (prior) {
    if (auto valid = prior->validate(); !valid) return rejected(valid.error().message);
    up_target = prior->up_target.normalized();
    up_source = prior->T_target_source.linear().transpose() * up_target;
  }
  return register_clouds(PreparedCloud(target, up_target, config), PreparedCloud(source, up_source, config),
                         config, prior, drifts);
}

}  // namespace fleetmap::registration
