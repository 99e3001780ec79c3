#include "comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fleetmap::registration {
namespace {

constexpr int kMinPatchPoints = 3;

bool was_observed(const CorrelationGrid& map, const Eigen::Vector3f& p) {
  const Eigen::Vector2f g = (p.head<2>() - map.origin) / (map.cell_m * static_cast<float>(kObservedCells));
  if (!(g.x() >= 0.0f && g.y() >= 0.0f)) return false;
  const int x = static_cast<int>(g.x()), y = static_cast<int>(g.y());
  if (x >= map.observed_size.x() || y >= map.observed_size.y()) return false;
  return map.observed[static_cast<std::size_t>(y * map.observed_size.x() + x)] != 0;
}

struct PointFit {
  bool observed = false;
  bool near = false;     ///< a surfel is near whose normal does not contradict
  float squared = 0.0f;  ///< m^2, distance from it in the directions that it constrains
};

PointFit fit_of(const Surfel* surfel, const CorrelationGrid& flat, const Eigen::Vector3f& p,
                const Facing& own, const Eigen::Matrix3f& R, const RegistrationConfig& config) {
  PointFit fit;
  if (surfel == nullptr) {
    fit.observed = was_observed(flat, p);
    return fit;
  }
  fit.observed = true;
  if (surfel->planar && own.planar &&
      std::abs(surfel->axes[0].dot(R * own.normal)) < config.icp.min_normal_agreement)
    return fit;
  fit.near = true;
  const Eigen::Vector3f d = p - surfel->mean;
  if (surfel->directions == 0) fit.squared = 0.1f * d.squaredNorm();
  if (surfel->directions == 3) fit.squared = d.squaredNorm();
  if (surfel->directions == 1 || surfel->directions == 2) {
    const float r = surfel->axes[0].dot(d), q = surfel->directions == 2 ? surfel->axes[1].dot(d) : 0.0f;
    fit.squared = r * r + q * q;
  }
  return fit;
}

/// Calls `use(index, fit)` for every point of `moving`.
template <class Use>
void for_each_fit(const PreparedCloud::Data& fixed, const MovingPoints& moving, const Pose& T,
                  const RegistrationConfig& config, Use use) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  std::array<Eigen::Vector3f, SurfelMap::kBlock> moved;
  std::array<const Surfel*, SurfelMap::kBlock> surfels;
  for (std::size_t from = 0; from < moving.points.size(); from += SurfelMap::kBlock) {
    const std::size_t count = std::min(SurfelMap::kBlock, moving.points.size() - from);
    for (std::size_t k = 0; k < count; ++k) moved[k] = R * moving.points[from + k] + t;
    fixed.surfels.find({moved.data(), count}, SurfelMap::Reach::near, surfels.data());
    for (std::size_t k = 0; k < count; ++k)
      use(from + k, fit_of(surfels[k], fixed.flat, moved[k], moving.facing[from + k], R, config));
  }
}

struct Total {
  double misfit = 0.0, squares = 0.0;
  std::size_t inliers = 0, observed = 0, above_floor = 0, above_floor_inliers = 0;
};

void compare_one_way(const PreparedCloud::Data& fixed, const MovingPoints& moving, const Pose& T,
                     const RegistrationConfig& config, std::size_t first_patch, Fit& fit, Total& total) {
  const float half2 = config.misfit_m * config.misfit_m, inlier2 = config.inlier_m * config.inlier_m;
  for_each_fit(fixed, moving, T, config, [&](std::size_t i, const PointFit& point) {
    if (!point.observed) return;
    const float misfit = point.near ? point.squared / (point.squared + half2) : 1.0f;
    ++total.observed;
    total.above_floor += moving.above_floor[i];
    total.misfit += static_cast<double>(misfit);
    fit.misfit[first_patch + moving.patches[i]] += misfit;
    ++fit.observed[first_patch + moving.patches[i]];
    if (!point.near || point.squared > inlier2) return;
    ++total.inliers;
    total.above_floor_inliers += moving.above_floor[i];
    total.squares += static_cast<double>(point.squared);
  });
}

}  // namespace

Fit compare(const PreparedCloud::Data& target, const PreparedCloud::Data& source, const Pose& T,
            const RegistrationConfig& config) {
  Fit fit;
  fit.misfit.assign(source.fine.patch_count + target.fine.patch_count, 0.0f);
  fit.observed.assign(fit.misfit.size(), 0);
  Total forth, back;
  compare_one_way(target, source.fine, T, config, 0, fit, forth);
  compare_one_way(source, target.fine, T.inverse(), config, source.fine.patch_count, fit, back);
  for (std::size_t k = 0; k < fit.observed.size(); ++k) {
    if (fit.observed[k] > 0) fit.misfit[k] /= static_cast<float>(fit.observed[k]);
  }
  const auto observed = static_cast<double>(forth.observed + back.observed);
  fit.score = observed > 0.0 ? 1.0 - (forth.misfit + back.misfit) / observed : 0.0;
  if (forth.above_floor > 0)
    fit.agreement = static_cast<double>(forth.above_floor_inliers) / static_cast<double>(forth.above_floor);
  fit.inliers = forth.inliers;
  fit.overlapping = forth.observed;
  fit.scored = source.fine.points.size();
  fit.rmse = forth.inliers > 0 ? std::sqrt(forth.squares / static_cast<double>(forth.inliers)) : 0.0;
  return fit;
}

double noise_of(const PreparedCloud::Data& data, const RegistrationConfig& config) {
  Fit fit;
  fit.misfit.assign(data.fine.patch_count, 0.0f);
  fit.observed.assign(data.fine.patch_count, 0);
  Total total;
  compare_one_way(data, data.fine, Pose::Identity(), config, 0, fit, total);
  return total.inliers > 0 ? std::sqrt(total.squares / static_cast<double>(total.inliers)) : 0.0;
}

double coarse_misfit(const PreparedCloud::Data& target, const PreparedCloud::Data& source, const Pose& T,
                     const RegistrationConfig& config) {
  const float half2 = config.misfit_m * config.misfit_m;
  double misfit = 0.0, observed = 0.0;
  for_each_fit(target, source.coarse, T, config, [&](std::size_t, const PointFit& point) {
    if (!point.observed) return;
    observed += 1.0;
    misfit += point.near ? static_cast<double>(point.squared / (point.squared + half2)) : 1.0;
  });
  if (observed < config.min_overlap * static_cast<double>(source.coarse.points.size())) return 1.0;
  return misfit / observed;
}

double evidence(const Fit& a, const Fit& b, std::optional<double> chance) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < a.misfit.size(); ++k) {
    const bool by_a = a.observed[k] >= kMinPatchPoints, by_b = b.observed[k] >= kMinPatchPoints;
    if (!by_a && !by_b) continue;
    if (!(by_a && by_b) && !chance) continue;
    const double difference = (by_b ? static_cast<double>(b.misfit[k]) : *chance) -
                              (by_a ? static_cast<double>(a.misfit[k]) : *chance);
    sum += difference;
    squares += difference * difference;
  }
  if (!(squares > 0.0)) return 0.0;
  return 0.5 * sum * std::abs(sum) / squares;
}

}  // namespace fleetmap::registration
