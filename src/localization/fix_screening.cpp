#include "fix_screening.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace fleetmap::localization {
namespace {

constexpr double kMaxAltitude = 20e3;  ///< m
constexpr double kReachSlack = 10.0;   ///< m

}  // namespace

BoundedCovariance bounded_covariance(const Eigen::Matrix3d& reported, const GpsModel& model) {
  const Eigen::Vector3d fallback(model.default_sigma_h, model.default_sigma_h, model.default_sigma_v);
  BoundedCovariance replaced{fallback.cwiseAbs2().asDiagonal(), true};
  // Sums of huge numbers overflow inside the decomposition: such covariances are replaced.
  if (!reported.allFinite() || reported.cwiseAbs().maxCoeff() > 1e18) return replaced;
  if (reported.diagonal().minCoeff() <= 0.0) return replaced;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (reported + reported.transpose()));
  if (eigen.info() != Eigen::Success) return replaced;
  const double floor = model.sigma_floor * model.sigma_floor;
  const double ceiling = model.sigma_ceiling * model.sigma_ceiling;
  const Eigen::Vector3d bounded = eigen.eigenvalues().cwiseMax(floor).cwiseMin(ceiling);
  return {eigen.eigenvectors() * bounded.asDiagonal() * eigen.eigenvectors().transpose(), false};
}

bool is_usable(const sensor::Fix& fix) {
  if (!fix.valid || !is_valid(fix.position)) return false;
  if (std::abs(fix.position.altitude) > kMaxAltitude) return false;
  return fix.position.latitude != 0.0 || fix.position.longitude != 0.0;
}

bool is_reachable(const GeoPoint& from, const GeoPoint& to, double dt, double sigma, const GpsModel& model) {
  const double distance = std::hypot(haversine_distance(from, to),
                                     std::max(0.0, std::abs(from.altitude - to.altitude) - 4.0 * sigma));
  return distance <= model.max_speed * dt + 6.0 * sigma + kReachSlack;
}

void extend_run(FixRun& run, const sensor::Fix& fix, double sigma, const GpsModel& model) {
  const bool agrees =
      run.count > 0 && is_reachable(run.position, fix.position, to_seconds(fix.stamp - run.last),
                                    std::max(run.sigma, sigma), model);
  if (!agrees) {
    run.count = 0;
    run.first = fix.stamp;
  }
  ++run.count;
  run.last = fix.stamp;
  run.position = fix.position;
  run.sigma = sigma;
}

}  // namespace fleetmap::localization
