#include "fleetmap/place/proximity_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fleetmap::place {

Status ProximityConfig::validate() const {
  if (!(radius_per_sigma > 0.0) || !std::isfinite(radius_per_sigma)) {
    return failure("radius_per_sigma: must be a finite number > 0");
  }
  if (!(min_radius >= 0.0) || !std::isfinite(min_radius)) {
    return failure("min_radius: must be a finite number of metres >= 0");
  }
  if (!(max_radius >= min_radius) || !std::isfinite(max_radius)) {
    return failure("max_radius: must be a finite number of metres >= min_radius");
  }
  return {};
}

double horizontal_sigma(const Matrix6d& C_ekf) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const double a = C_ekf(0, 0);
  const double b = 0.5 * (C_ekf(0, 1) + C_ekf(1, 0));
  const double c = C_ekf(1, 1);
  const double mean = 0.5 * (a + c);
  const double spread = std::hypot(0.5 * (a - c), b);
  if (!std::isfinite(mean) || !std::isfinite(spread)) return kUnknown;
  // Rounding may push the smaller eigenvalue of a sound matrix a hair below zero.
  if (mean - spread < -1e-9 * std::max(1.0, std::abs(mean))) return kUnknown;
  return std::sqrt(std::max(0.0, mean + spread));
}

bool tells_place(const std::optional<GlobalPose>& G, double max_sigma_m) {
  return G && is_valid(G->position) && horizontal_sigma(G->covariance) <= max_sigma_m;
}

double search_radius(double horizontal_sigma_m, const ProximityConfig& config) {
  if (!(horizontal_sigma_m >= 0.0)) return config.max_radius;
  return std::clamp(horizontal_sigma_m * config.radius_per_sigma, config.min_radius, config.max_radius);
}

double search_radius(const Matrix6d& C_ekf, const ProximityConfig& config) {
  return search_radius(horizontal_sigma(C_ekf), config);
}

std::optional<Neighbor> nearest_within(const BallTree& tree, const GeoPoint& point, double radius_m) {
  const auto nearest = tree.nearest(point);
  if (!nearest || !(nearest->distance <= radius_m)) return std::nullopt;
  return nearest;
}

std::optional<Neighbor> find_proximity(const BallTree& own_nodes, const GlobalPose& G_i,
                                       const ProximityConfig& config) {
  return nearest_within(own_nodes, G_i.position, search_radius(G_i.covariance, config));
}

}  // namespace fleetmap::place
