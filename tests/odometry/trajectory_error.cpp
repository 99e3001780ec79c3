#include "odometry/trajectory_error.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

namespace fleetmap::testing {

double aligned_rmse(const std::vector<Pose>& estimate, const std::vector<Pose>& truth) {
  const auto n = static_cast<Eigen::Index>(estimate.size());
  Eigen::Matrix3Xd a(3, n), b(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.col(i) = estimate[static_cast<std::size_t>(i)].translation();
    b.col(i) = truth[static_cast<std::size_t>(i)].translation();
  }
  const Eigen::Matrix4d T = Eigen::umeyama(a, b, false);
  const Eigen::Matrix3Xd error = ((T.topLeftCorner<3, 3>() * a).colwise() + T.topRightCorner<3, 1>()) - b;
  return std::sqrt(error.colwise().squaredNorm().mean());
}

double relative_drift(const std::vector<Pose>& estimate, const std::vector<Pose>& truth, double length) {
  std::vector<double> path{0.0};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    path.push_back(path.back() + (truth[i].translation() - truth[i - 1].translation()).norm());
  }
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0, j = 0; i < truth.size(); ++i) {
    while (j < truth.size() && path[j] - path[i] < length) ++j;
    const bool whole = i == 0 && path.back() < length;
    if (j == truth.size() && !whole) break;
    const std::size_t end = whole ? truth.size() - 1 : j;
    const Pose error = (truth[i].inverse() * truth[end]).inverse() * (estimate[i].inverse() * estimate[end]);
    sum += error.translation().norm() / (path[end] - path[i]);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace fleetmap::testing
