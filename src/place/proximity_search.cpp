#include "fleetmap/place/proximity_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fleetmap::place {

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

bool has_known_position(const std::optional<GlobalPose>& G, double max_sigma_m) {
  return G && is_valid(G->position) && horizontal_sigma(G->covariance) <= max_sigma_m;
}

double search_radius(double horizontal_sigma_m, const ProximityConfig& config) {
  if (!(horizontal_sigma_m >= 0.0)) return config.max_radius;
  const double C = config.uncertainty == Uncertainty::variance ? horizontal_sigma_m * horizontal_sigma_m
                                                               : horizontal_sigma_m;
  return std::clamp(C * config.radius_scale, config.min_radius, config.max_radius);
}

double search_radius(const Matrix6d& C_ekf, const ProximityConfig& config) {
  return search_radius(horizontal_sigma(C_ekf), config);
}

std::optional<Proximity> find_proximity(const BallTree& own_nodes, const GlobalPose& G_i,
                                        const ProximityConfig& config) {
  const double radius = search_radius(G_i.covariance, config);
  const auto nearest = own_nodes.nearest(G_i.position);
  if (!nearest || !(nearest->distance <= radius)) return std::nullopt;
  return Proximity{*nearest, radius};
}

}  // namespace fleetmap::place
