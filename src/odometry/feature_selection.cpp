#include "feature_selection.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/core/cpu_time.hpp"

namespace fleetmap::odometry {

double SelectedFeatures::half_sweep() const {
  double half = 0.0;
  for (const FeaturePoint& p : match_planes) half = std::max(half, std::abs(static_cast<double>(p.time)));
  return half;
}

const Features& FeatureSelector::extract(const Sweep& sweep, StageTimes& cpu) {
  const CpuTimer timer(cpu.features);
  return extractor_.extract(sweep);
}

const SelectedFeatures& FeatureSelector::select(const Sweep& sweep, StageTimes& cpu) {
  const Features& features = extract(sweep, cpu);
  const CpuTimer timer(cpu.thinning);
  selected_.match_planes.clear();
  selected_.insert_planes.clear();
  match_thinning_.clear();
  insert_thinning_.clear();
  const auto position = [&](std::size_t k) -> const Eigen::Vector3f& {
    return sweep.points[features.planes[k]].position;
  };
  insert_thinning_.for_each_first(features.planes.size(), position, [&](std::size_t k) {
    const SweepPoint& p = sweep.points[features.planes[k]];
    const float time = deskew_ ? p.time : 0.0f;
    selected_.insert_planes.push_back({p.position, time});
    if (match_thinning_.first_in_cube(p.position)) selected_.match_planes.push_back({p.position, time});
  });
  selected_.edges.assign(features.edges.begin(), features.edges.end());
  for (FeaturePoint& p : selected_.edges) p.time *= deskew_ ? 1.0f : 0.0f;
  return selected_;
}

}  // namespace fleetmap::odometry
