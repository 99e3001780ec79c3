#include "fit_to_truth.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::eval {
namespace {

constexpr int kIterations = 12;            ///< a stage
constexpr double kDegenerateShare = 1e-3;  ///< of the largest eigenvalue: less is no constraint
constexpr double kSmallStep = 1e-4;        ///< m, and rad times the lever, that end a stage

struct System {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
};

System linearize(const TruthPlanes& truth, const std::vector<Eigen::Vector3f>& map, const Pose& T,
                 float max_distance) {
  System system;
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const double kernel = static_cast<double>(max_distance) * static_cast<double>(max_distance);
  for (const Eigen::Vector3f& q : map) {
    const Eigen::Vector3f p = R * q + t;
    const auto match = truth.tree.nearest(p, max_distance);
    if (!match || truth.normals[match->index].isZero()) continue;
    const Eigen::Vector3f& n = truth.normals[match->index];
    const Eigen::Vector3f n_map = R.transpose() * n;
    const auto r = static_cast<double>(n.dot(p - truth.points[match->index]));
    const double w = std::pow(kernel / (kernel + r * r), 2);
    Vector6d J;
    J << n_map.cast<double>(), q.cross(n_map).cast<double>();
    system.H.selfadjointView<Eigen::Lower>().rankUpdate(J, w);
    system.g += (w * r) * J;
  }
  system.H = Matrix6d(system.H.selfadjointView<Eigen::Lower>());
  return system;
}

/// m that a radian moves a point, root mean square.
double lever_of(const std::vector<Eigen::Vector3f>& points) {
  double squares = 0.0;
  for (const Eigen::Vector3f& p : points) squares += static_cast<double>(p.squaredNorm());
  return std::max(1.0, std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, points.size()))));
}

/// In metres: rotations times the lever.
Vector6d step_of(const System& system, const Vector6d& metres) {
  const Vector6d inverse = metres.cwiseInverse();
  const Matrix6d H = inverse.asDiagonal() * system.H * inverse.asDiagonal();
  const Vector6d g = inverse.cwiseProduct(system.g);
  const SymmetricEigen eigen = eigen_of_symmetric(H);
  const double floor = kDegenerateShare * eigen.values[5];
  Vector6d step = Vector6d::Zero();
  if (!(floor > 0.0)) return step;
  for (int k = 0; k < 6; ++k) {
    if (eigen.values[k] < floor) continue;
    step -= eigen.vectors.col(k).dot(g) / eigen.values[k] * eigen.vectors.col(k);
  }
  return step;
}

}  // namespace

Pose fit_to_truth(const TruthPlanes& truth, const std::vector<Eigen::Vector3f>& map,
                  std::span<const float> max_distances) {
  Pose T = Pose::Identity();
  const double lever = lever_of(map);
  Vector6d metres;
  metres << 1.0, 1.0, 1.0, lever, lever, lever;
  for (const float max_distance : max_distances) {
    for (int k = 0; k < kIterations; ++k) {
      const Vector6d step = step_of(linearize(truth, map, T, max_distance), metres);
      if (!step.allFinite()) return T;
      T = T * se3_exp(step.cwiseQuotient(metres));
      if (step.norm() < kSmallStep) break;
    }
  }
  return T;
}

}  // namespace fleetmap::eval
