#include "fleetmap/registration/register_clouds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::registration {
namespace {

using cloud::KdTree;
using cloud::Normals;
using cloud::PointCloud;

/// The cloud that stays, with all that registration asks of it.
struct Target {
  PointCloud cloud;
  KdTree tree;
  Normals normals;
  Target(PointCloud thinned, const cloud::NormalConfig& config)
      : cloud(std::move(thinned)), tree(cloud), normals(estimate_normals(cloud, tree, config)) {}
};

/// Points of the cloud that moves, evenly picked.
struct Sample {
  PointCloud cloud;
  Normals normals;
};

std::vector<std::size_t> even_picks(std::size_t size, std::size_t count) {
  std::vector<std::size_t> picks;
  const std::size_t wanted = std::min(count, size);
  for (std::size_t k = 0; k < wanted; ++k) picks.push_back(k * size / wanted);
  return picks;
}

Sample sample_of(const PointCloud& whole, std::size_t count, const cloud::NormalConfig& config) {
  const auto picks = even_picks(whole.size(), count);
  return {select(whole, picks), estimate_normals(whole, KdTree(whole), config, picks)};
}

Sample sample_of(const Sample& whole, std::size_t count) {
  const auto picks = even_picks(whole.cloud.size(), count);
  Sample sample{select(whole.cloud, picks), {}};
  for (const std::size_t i : picks) {
    sample.normals.normals.push_back(whole.normals.normals[i]);
    sample.normals.variations.push_back(whole.normals.variations[i]);
  }
  return sample;
}

struct Fit {
  double score = 0.0;
  double rmse = 0.0;
  std::size_t inliers = 0;
  std::size_t overlapping = 0;
};

Fit measure(const Target& target, const Sample& source, const Pose& T, const RegistrationConfig& config) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const float inlier2 = config.inlier_m * config.inlier_m;
  Fit fit;
  double squares = 0.0;
  for (std::size_t i = 0; i < source.cloud.size(); ++i) {
    const auto match = target.tree.nearest(R * source.cloud.points[i] + t, config.overlap_m);
    if (!match) continue;
    ++fit.overlapping;
    if (match->squared_distance >= inlier2) continue;
    const Eigen::Vector3f& n_target = target.normals.normals[match->index];
    const Eigen::Vector3f& n_source = source.normals.normals[i];
    const bool both = !n_target.isZero() && !n_source.isZero();
    if (both && std::abs(n_target.dot(R * n_source)) < config.icp.min_normal_agreement) continue;
    ++fit.inliers;
    squares += static_cast<double>(match->squared_distance);
    fit.score += 1.0 - static_cast<double>(match->squared_distance / inlier2);
  }
  fit.score /= static_cast<double>(std::max<std::size_t>(1, source.cloud.size()));
  fit.rmse = fit.inliers > 0 ? std::sqrt(squares / static_cast<double>(fit.inliers)) : 0.0;
  return fit;
}

/// Thins `cloud` until it has few enough points for features.
PointCloud feature_cloud(const PointCloud& cloud, const RegistrationConfig& config) {
  float voxel_m = config.feature_voxel_m;
  PointCloud thin = voxel_downsample(cloud, voxel_m);
  while (thin.size() > config.max_feature_points && 2.0f * voxel_m < config.feature_radius_m) {
    voxel_m *= 1.25f;
    thin = voxel_downsample(cloud, voxel_m);
  }
  return thin;
}

struct FeatureCloud {
  PointCloud cloud;
  Features features;
};

FeatureCloud features_of(const PointCloud& whole, const RegistrationConfig& config) {
  PointCloud cloud = feature_cloud(whole, config);
  const Normals normals = estimate_normals(cloud, KdTree(cloud), config.feature_normals);
  Features features = compute_fpfh(cloud, normals, config.feature_radius_m);
  return {std::move(cloud), std::move(features)};
}

/// A pose to refine: what the features propose, or the prior.
struct Start {
  Pose T = Pose::Identity();
  bool from_prior = false;
};

std::vector<Start> starts_of(const PointCloud& target, const PointCloud& source,
                             const RegistrationConfig& config, const std::optional<Prior>& prior,
                             std::size_t& correspondence_count) {
  const FeatureCloud a = features_of(target, config);
  const FeatureCloud b = features_of(source, config);
  const auto correspondences = match_features(a.features, b.features, config.matching);
  correspondence_count = correspondences.size();
  std::vector<Start> starts;
  if (prior) starts.push_back({prior->T_target_source, true});
  for (const Hypothesis& hypothesis : ransac(a.cloud, b.cloud, correspondences, config.ransac, prior)) {
    starts.push_back({hypothesis.T_target_source, false});
  }
  return starts;
}

struct Refined {
  Mode mode;
  IcpResult icp;
  Fit fit;
};

Refined refine(const Target& target, const Sample& source, const Start& start,
               const RegistrationConfig& config) {
  Refined refined;
  refined.icp =
      icp({target.cloud, target.tree, target.normals}, {source.cloud, source.normals}, start.T, config.icp);
  refined.fit = measure(target, source, refined.icp.T_target_source, config);
  const auto count = static_cast<double>(source.cloud.size());
  refined.mode = {refined.icp.T_target_source,
                  refined.fit.score,
                  refined.fit.rmse,
                  static_cast<double>(refined.fit.inliers) / count,
                  static_cast<double>(refined.fit.overlapping) / count,
                  start.from_prior};
  return refined;
}

/// Refines every start, drops what the prior excludes, joins what ends at the same pose; best first.
std::vector<Refined> refined_modes(const Target& target, const Sample& source,
                                   const std::vector<Start>& starts, const RegistrationConfig& config,
                                   const std::optional<Prior>& prior) {
  std::vector<Refined> modes;
  for (const Start& start : starts) {
    Refined refined = refine(target, source, start, config);
    if (prior && !agrees(*prior, refined.mode.T_target_source, config.ransac.prior_sigmas)) continue;
    const auto twin = std::find_if(modes.begin(), modes.end(), [&](const Refined& other) {
      return same_mode(other.mode.T_target_source, refined.mode.T_target_source, config.ransac.distinct_m,
                       config.ransac.distinct_rad);
    });
    if (twin == modes.end()) {
      modes.push_back(std::move(refined));
    } else if (refined.mode.score > twin->mode.score) {
      *twin = std::move(refined);
    }
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Refined& a, const Refined& b) { return a.mode.score > b.mode.score; });
  return modes;
}

/// The starts worth a coarse ICP: the prior, and the best of the rest as they stand.
std::vector<Start> promising(const Target& target, const Sample& source, std::vector<Start> starts,
                             const RegistrationConfig& config) {
  std::vector<double> scores;
  for (const Start& start : starts) {
    scores.push_back(start.from_prior ? 2.0 : measure(target, source, start.T, config).score);
  }
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
  std::vector<Start> best;
  for (const std::size_t i : order) {
    if (best.size() <
        config.max_modes + (starts[i].from_prior || (!best.empty() && best[0].from_prior) ? 1u : 0u)) {
      best.push_back(starts[i]);
    }
  }
  return best;
}

/// Coarse modes first, then only the contenders with all points.
std::vector<Refined> find_modes(const Target& target, const Sample& source, std::vector<Start> starts,
                                const RegistrationConfig& config, const std::optional<Prior>& prior) {
  const Sample coarse = sample_of(source, config.max_coarse_points);
  const auto coarse_modes =
      refined_modes(target, coarse, promising(target, coarse, std::move(starts), config), config, prior);
  std::vector<Start> contenders;
  for (const Refined& refined : coarse_modes) {
    if (refined.mode.score < config.contender_share * coarse_modes.front().mode.score) break;
    contenders.push_back({refined.mode.T_target_source, refined.mode.from_prior});
  }
  return refined_modes(target, source, contenders, config, prior);
}

std::string text(const char* format, double value, double limit) {
  char line[160];
  std::snprintf(line, sizeof line, format, value, limit);
  return line;
}

/// Sets verdict and reason from the numbers already in `result`.
void judge(RegistrationResult& result, const RegistrationConfig& config) {
  result.verdict = Verdict::rejected;
  if (result.inliers < config.min_inliers) {
    result.reason = text("only %.0f inliers, at least %.0f are needed", static_cast<double>(result.inliers),
                         static_cast<double>(config.min_inliers));
  } else if (result.inlier_fraction < config.min_inlier_fraction) {
    result.reason = text(
        "only %.2f of the source points are inliers, at least %.2f are needed: the clouds overlap too "
        "little",
        result.inlier_fraction, config.min_inlier_fraction);
  } else if (result.agreement < config.min_agreement) {
    result.reason = text("where the clouds overlap they agree to %.2f, at least %.2f is needed",
                         result.agreement, config.min_agreement);
  } else if (result.rmse > config.max_rmse_m) {
    result.reason = text("inlier RMSE is %.2f m, at most %.2f m is good", result.rmse, config.max_rmse_m);
  } else if (result.modes.size() > 1 &&
             result.modes[1].score >= config.ambiguous_share * result.modes[0].score) {
    result.verdict = Verdict::ambiguous;
    const Eigen::Vector3d apart =
        result.modes[1].T_target_source.translation() - result.modes[0].T_target_source.translation();
    result.reason = text("another pose %.1f m away fits %.2f times as well", apart.norm(),
                         result.modes[1].score / result.modes[0].score);
  } else {
    result.verdict = Verdict::accepted;
  }
}

PointCloud thinned(const PointCloud& cloud, float voxel_m) {
  PointCloud points_only;
  points_only.points = cloud.points;
  return voxel_downsample(points_only, voxel_m);
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

Status RegistrationConfig::validate() const {
  if (!(voxel_m > 0.0f)) return failure("registration voxel_m must be positive");
  if (!(feature_voxel_m > 0.0f)) return failure("registration feature_voxel_m must be positive");
  if (!(feature_radius_m > feature_voxel_m))
    return failure("registration feature_radius_m must exceed feature_voxel_m");
  if (!(inlier_m > 0.0f)) return failure("registration inlier_m must be positive");
  if (!(overlap_m >= inlier_m)) return failure("registration overlap_m must be at least inlier_m");
  if (max_icp_points < 10) return failure("registration max_icp_points must be at least 10");
  if (max_modes < 1) return failure("registration max_modes must be at least 1");
  for (const Status& part :
       {normals.validate(), feature_normals.validate(), ransac.validate(), icp.validate()}) {
    if (!part) return failure("registration: " + part.error().message);
  }
  return {};
}

RegistrationResult register_clouds(const PointCloud& target_cloud, const PointCloud& source_cloud,
                                   const RegistrationConfig& config, const std::optional<Prior>& prior) {
  RegistrationResult result;
  if (auto valid = config.validate(); !valid) {
    result.reason = valid.error().message;
    return result;
  }
  if (prior) {
    if (auto valid = prior->validate(); !valid) {
      result.reason = valid.error().message;
      return result;
    }
  }
  PointCloud target_points = thinned(target_cloud, config.voxel_m);
  const PointCloud source_points = thinned(source_cloud, config.voxel_m);
  const std::size_t fewest = std::min(target_points.size(), source_points.size());
  if (fewest < config.min_points) {
    result.reason = text("a cloud has only %.0f points after thinning, at least %.0f are needed",
                         static_cast<double>(fewest), static_cast<double>(config.min_points));
    return result;
  }
  std::vector<Start> starts = starts_of(target_points, source_points, config, prior, result.correspondences);
  const Target target(std::move(target_points), config.normals);
  const Sample sample = sample_of(source_points, config.max_icp_points, config.normals);
  const std::vector<Refined> modes = find_modes(target, sample, std::move(starts), config, prior);
  if (modes.empty()) {
    result.reason = "no pose is supported by the features" + std::string(prior ? " within the prior" : "");
    return result;
  }
  for (const Refined& refined : modes) result.modes.push_back(refined.mode);
  const Refined& best = modes.front();
  result.T_target_source = best.mode.T_target_source;
  result.rmse = best.mode.rmse;
  result.covariance = best.icp.covariance;
  result.inlier_fraction = best.mode.inlier_fraction;
  result.overlap = best.mode.overlap;
  result.agreement = best.mode.overlap > 0.0 ? best.mode.score / best.mode.overlap : 0.0;
  result.inliers = best.fit.inliers;
  result.scored = sample.cloud.size();
  judge(result, config);
  return result;
}

}  // namespace fleetmap::registration
