#include "fleetmap/registration/register_clouds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::registration {
namespace {

using cloud::KdTree;
using cloud::Normals;
using cloud::PointCloud;

/// A cloud with all that registration asks of it.
struct Prepared {
  PointCloud cloud;
  KdTree tree;
  Normals normals;
  Prepared(PointCloud thinned, const cloud::NormalConfig& config)
      : cloud(std::move(thinned)), tree(cloud), normals(estimate_normals(cloud, tree, config)) {}
};

struct Sample {
  PointCloud cloud;
  Normals normals;
};

Sample sample_of(const Prepared& whole, std::size_t count) {
  Sample sample;
  const std::size_t size = whole.cloud.size();
  const std::size_t wanted = std::min(count, size);
  for (std::size_t k = 0; k < wanted; ++k) {
    const std::size_t i = k * size / wanted;
    sample.cloud.points.push_back(whole.cloud.points[i]);
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

Fit measure(const Prepared& target, const Sample& source, const Pose& T, const RegistrationConfig& config,
            std::size_t stride = 1) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const float inlier2 = config.inlier_m * config.inlier_m;
  Fit fit;
  double squares = 0.0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < source.cloud.size(); i += stride) {
    ++seen;
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
  fit.score /= static_cast<double>(std::max<std::size_t>(1, seen));
  fit.rmse = fit.inliers > 0 ? std::sqrt(squares / static_cast<double>(fit.inliers)) : 0.0;
  return fit;
}

/// Poses to refine: what the features propose, and the prior.
struct Start {
  Pose T = Pose::Identity();
  bool from_prior = false;
  double score = 0.0;
};

std::vector<Start> feature_starts(const Prepared& target, const Prepared& source,
                                  const RegistrationConfig& config, const std::optional<Prior>& prior,
                                  std::size_t& correspondence_count) {
  const Prepared a(voxel_downsample(target.cloud, config.feature_voxel_m), config.feature_normals);
  const Prepared b(voxel_downsample(source.cloud, config.feature_voxel_m), config.feature_normals);
  const auto correspondences =
      match_features(compute_fpfh(a.cloud, a.normals, config.feature_radius_m),
                     compute_fpfh(b.cloud, b.normals, config.feature_radius_m), config.matching);
  correspondence_count = correspondences.size();
  std::vector<Start> starts;
  for (const Hypothesis& hypothesis : ransac(a.cloud, b.cloud, correspondences, config.ransac, prior)) {
    starts.push_back({hypothesis.T_target_source, false, 0.0});
  }
  return starts;
}

struct Refined {
  Mode mode;
  IcpResult icp;
  Fit fit;
};

Refined refine(const Prepared& target, const Sample& source, const Start& start,
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

std::string text(const char* format, double value, double limit) {
  char line[160];
  std::snprintf(line, sizeof line, format, value, limit);
  return line;
}

/// Sets verdict and reason from the numbers already in `result`.
void judge(RegistrationResult& result, const RegistrationConfig& config) {
  const double agreement = result.overlap > 0.0 ? result.inlier_fraction / result.overlap : 0.0;
  result.verdict = Verdict::rejected;
  if (result.inliers < config.min_inliers) {
    result.reason = text("only %.0f inliers, at least %.0f are needed", static_cast<double>(result.inliers),
                         static_cast<double>(config.min_inliers));
  } else if (result.inlier_fraction < config.min_inlier_fraction) {
    result.reason = text(
        "only %.2f of the source points are inliers, at least %.2f are needed: the clouds overlap too "
        "little",
        result.inlier_fraction, config.min_inlier_fraction);
  } else if (agreement < config.min_agreement) {
    result.reason = text("in the overlap only %.2f of the points agree, at least %.2f must", agreement,
                         config.min_agreement);
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
  const Prepared target(thinned(target_cloud, config.voxel_m), config.normals);
  const Prepared source(thinned(source_cloud, config.voxel_m), config.normals);
  const std::size_t fewest = std::min(target.cloud.size(), source.cloud.size());
  if (fewest < config.min_points) {
    result.reason = text("a cloud has only %.0f points after thinning, at least %.0f are needed",
                         static_cast<double>(fewest), static_cast<double>(config.min_points));
    return result;
  }
  const Sample sample = sample_of(source, config.max_icp_points);

  std::vector<Start> starts = feature_starts(target, source, config, prior, result.correspondences);
  if (prior) starts.push_back({prior->T_target_source, true, 0.0});
  for (Start& start : starts) start.score = measure(target, sample, start.T, config, 8).score;
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.score > b.score; });
  const auto beyond = [&](const Start& start) {
    return !start.from_prior && static_cast<std::size_t>(&start - starts.data()) >= config.max_modes;
  };

  std::vector<Refined> modes;
  for (const Start& start : starts) {
    if (beyond(start)) continue;
    Refined refined = refine(target, sample, start, config);
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
  if (modes.empty()) {
    result.reason = "no pose is supported by the features" + std::string(prior ? " within the prior" : "");
    return result;
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Refined& a, const Refined& b) { return a.mode.score > b.mode.score; });
  for (const Refined& refined : modes) result.modes.push_back(refined.mode);
  const Refined& best = modes.front();
  result.T_target_source = best.mode.T_target_source;
  result.rmse = best.mode.rmse;
  result.covariance = best.icp.covariance;
  result.inlier_fraction = best.mode.inlier_fraction;
  result.overlap = best.mode.overlap;
  result.inliers = best.fit.inliers;
  result.scored = sample.cloud.size();
  judge(result, config);
  return result;
}

}  // namespace fleetmap::registration
