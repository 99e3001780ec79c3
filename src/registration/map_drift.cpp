#include "fleetmap/registration/map_drift.hpp"

#include <cmath>

namespace fleetmap::registration {
namespace {

constexpr double kSpacing = 4.0;  // m, of the stops of a straight path

}  // namespace

MapDrift MapDrift::straight(double sigma_m, double sigma_rad, double reach_m) {
  const int half = static_cast<int>(std::ceil(reach_m / kSpacing));
  MapDrift drift;
  for (int k = -half; k <= half; ++k) {
    MapStop stop;
    stop.T_cloud_base.translation().x() = k * kSpacing;
    stop.step_covariance.diagonal().head<3>().setConstant(kSpacing * sigma_m * sigma_m);
    stop.step_covariance.diagonal().tail<3>().setConstant(kSpacing * sigma_rad * sigma_rad);
    drift.stops.push_back(stop);
  }
  return drift;
}

Status MapDrift::validate() const {
  for (const MapStop& stop : stops) {
    if (!all_finite(stop.T_cloud_base)) return failure("map drift: poses of stops must be finite");
    if (!stop.step_covariance.allFinite() || !(stop.step_covariance.diagonal().array() >= 0.0).all())
      return failure("map drift: covariances of steps must be finite, their diagonals not negative");
  }
  return {};
}

}  // namespace fleetmap::registration
