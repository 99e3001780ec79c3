#pragma once

#include <Eigen/Eigenvalues>

#include "fleetmap/localization/filter.hpp"

namespace fleetmap::localization::testing {

/// A filter that estimates everything, at 100 s, level at the origin.
inline Filter tracking_filter() {
  Filter filter;
  filter.stamp = stamp_from_ns(100'000'000'000);
  filter.phase = Phase::kTracking;
  filter.started = filter.attitude_set = filter.heading_set = true;
  filter.P = 0.01 * Covariance::Identity();
  return filter;
}

inline sensor::Wheel wheel_at(Stamp stamp, double speed, std::optional<double> yaw_rate = std::nullopt) {
  sensor::Wheel wheel;
  wheel.stamp = stamp;
  wheel.forward_speed = speed;
  wheel.yaw_rate = yaw_rate;
  return wheel;
}

inline double min_eigenvalue(const Covariance& P) {
  return Eigen::SelfAdjointEigenSolver<Covariance>(P).eigenvalues().minCoeff();
}

}  // namespace fleetmap::localization::testing
