#include "fleetmap/eval/map_metrics_config.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace fleetmap::eval {

Status MapMetricsConfig::validate() const {
  for (const auto& [name, value] : {std::pair{"inlier_distance", inlier_distance},
                                    {"density_radius", density_radius},
                                    {"truth_reach", truth_reach},
                                    {"resolution", resolution},
                                    {"registration_distance", registration_distance},
                                    {"min_noise", min_noise},
                                    {"thresholds[0]", thresholds[0]},
                                    {"thresholds[1]", thresholds[1]},
                                    {"thresholds[2]", thresholds[2]}}) {
    if (!(value > 0.0) || !std::isfinite(value)) return failure(std::string(name) + " must be positive");
  }
  if (thresholds[2] > inlier_distance || !std::is_sorted(thresholds.begin(), thresholds.end()))
    return failure("thresholds must ascend and not exceed inlier_distance");
  for (const auto& [name, value] : {std::pair{"max_truth", max_truth},
                                    {"max_distances", max_distances},
                                    {"max_densities", max_densities}}) {
    if (value < 1000) return failure(std::string(name) + " must be at least 1000");
  }
  return {};
}

}  // namespace fleetmap::eval
