#include "fleetmap/registration/icp.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace fleetmap::registration {
namespace {

/// Normal equations of one linearisation.
struct System {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weights = 0.0;
  double squares = 0.0;                 ///< sum of weight * residual^2
  std::vector<Eigen::Vector3f> places;  ///< source points with a correspondence, when asked for
};

System linearize(const IcpTarget& target, const IcpSource& source, const Pose& T, float max_distance,
                 const IcpConfig& config, bool keep_places) {
  System system;
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const double kernel2 = std::pow(static_cast<double>(config.kernel_share * max_distance), 2);
  const bool have_normals = source.normals.normals.size() == source.cloud.size();
  for (std::size_t i = 0; i < source.cloud.size(); ++i) {
    const Eigen::Vector3f& q = source.cloud.points[i];
    const Eigen::Vector3f p = R * q + t;
    const auto match = target.tree.nearest(p, max_distance);
    if (!match) continue;
    const Eigen::Vector3f& n = target.normals.normals[match->index];
    if (n.isZero()) continue;
    const Eigen::Vector3f n_source = R.transpose() * n;
    if (have_normals && !source.normals.normals[i].isZero() &&
        std::abs(n_source.dot(source.normals.normals[i])) < config.min_normal_agreement) {
      continue;
    }
    const auto r = static_cast<double>(n.dot(p - target.cloud.points[match->index]));
    const double w = std::pow(kernel2 / (kernel2 + r * r), 2);
    Vector6d J;
    J << n_source.cast<double>(), q.cross(n_source).cast<double>();
    system.H.selfadjointView<Eigen::Lower>().rankUpdate(J, w);
    system.g += (w * r) * J;
    system.weights += w;
    system.squares += w * r * r;
    if (keep_places) system.places.push_back(q);
  }
  system.H = system.H.selfadjointView<Eigen::Lower>();
  return system;
}

/// Root mean square distance of the points from the source origin: how many metres a radian moves a point.
double lever_of(const cloud::PointCloud& cloud) {
  double squares = 0.0;
  for (const auto& p : cloud.points) squares += static_cast<double>(p.squaredNorm());
  return std::max(1.0, std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, cloud.size()))));
}

Vector6d scale_of(double lever) {
  Vector6d scale;
  scale << 1, 1, 1, lever, lever, lever;
  return scale;
}

struct Step {
  Vector6d xi = Vector6d::Zero();
  int unconstrained = 6;
};

/// Gauss-Newton step in the directions that the system constrains.
Step solve(const System& system, double lever, double degenerate_share) {
  const Vector6d inverse = scale_of(lever).cwiseInverse();
  const Matrix6d H = inverse.asDiagonal() * system.H * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(H);
  const double floor = degenerate_share * eigen.eigenvalues()[5];
  Step step;
  if (!(floor > 0.0)) return step;
  Vector6d y = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    if (eigen.eigenvalues()[k] < floor) continue;
    --step.unconstrained;
    y -= eigen.eigenvectors().col(k).dot(inverse.cwiseProduct(system.g)) / eigen.eigenvalues()[k] *
         eigen.eigenvectors().col(k);
  }
  step.xi = inverse.cwiseProduct(y);
  return step;
}

/// How many cubes of `edge` the places fall into.
std::size_t cubes_of(const std::vector<Eigen::Vector3f>& places, float edge) {
  std::vector<std::array<std::int32_t, 3>> cubes;
  cubes.reserve(places.size());
  for (const auto& p : places) {
    const Eigen::Array3f cube = (p / edge).array().floor().max(-2e9f).min(2e9f);
    cubes.push_back({static_cast<std::int32_t>(cube[0]), static_cast<std::int32_t>(cube[1]),
                     static_cast<std::int32_t>(cube[2])});
  }
  std::sort(cubes.begin(), cubes.end());
  return static_cast<std::size_t>(std::unique(cubes.begin(), cubes.end()) - cubes.begin());
}

Matrix6d covariance_of(const System& system, double lever, const IcpConfig& config) {
  const auto count = static_cast<double>(system.places.size());
  Matrix6d unknown =
      Vector6d(scale_of(lever).cwiseInverse().array().square() * config.max_stddev_m * config.max_stddev_m)
          .asDiagonal();
  if (count < 7.0) return unknown;
  const double noise =
      std::max(system.squares / std::max(1.0, system.weights), std::pow(config.min_noise_m, 2));
  const double independent = static_cast<double>(cubes_of(system.places, config.correlation_m)) / count;
  const Vector6d inverse = scale_of(lever).cwiseInverse();
  const Matrix6d information = inverse.asDiagonal() * system.H * inverse.asDiagonal() * (independent / noise);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
  const double least = 1.0 / (config.max_stddev_m * config.max_stddev_m);
  const Matrix6d scaled = eigen.eigenvectors() *
                          eigen.eigenvalues().cwiseMax(least).cwiseInverse().asDiagonal() *
                          eigen.eigenvectors().transpose();
  const Matrix6d covariance = inverse.asDiagonal() * scaled * inverse.asDiagonal();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

Status IcpConfig::validate() const {
  if (max_distances_m.empty()) return failure("icp max_distances_m must not be empty");
  for (const float distance : max_distances_m) {
    if (!(distance > 0.0f)) return failure("icp max_distances_m must be positive");
  }
  if (iterations_per_stage < 1) return failure("icp iterations_per_stage must be at least 1");
  if (!(kernel_share > 0.0f)) return failure("icp kernel_share must be positive");
  if (!(correlation_m > 0.0f)) return failure("icp correlation_m must be positive");
  if (!(max_stddev_m > 0.0)) return failure("icp max_stddev_m must be positive");
  if (!(min_noise_m > 0.0)) return failure("icp min_noise_m must be positive");
  return {};
}

IcpResult icp(const IcpTarget& target, const IcpSource& source, const Pose& T_initial,
              const IcpConfig& config) {
  IcpResult result;
  result.T_target_source = T_initial;
  const double lever = lever_of(source.cloud);
  for (std::size_t stage = 0; stage < config.max_distances_m.size(); ++stage) {
    const bool last = stage + 1 == config.max_distances_m.size();
    const double tolerance = last ? 0.1 : 1.0;
    for (int k = 0; k < config.iterations_per_stage; ++k) {
      const System system =
          linearize(target, source, result.T_target_source, config.max_distances_m[stage], config, false);
      const Step step = solve(system, lever, config.degenerate_share);
      if (!step.xi.allFinite()) return result;
      result.T_target_source = result.T_target_source * se3_exp(step.xi);
      ++result.iterations;
      result.converged = step.xi.head<3>().norm() < tolerance * config.converged_m &&
                         step.xi.tail<3>().norm() < tolerance * config.converged_rad;
      if (result.converged) break;
    }
  }
  const System system =
      linearize(target, source, result.T_target_source, config.max_distances_m.back(), config, true);
  result.unconstrained = solve(system, lever, config.degenerate_share).unconstrained;
  result.covariance = covariance_of(system, lever, config);
  return result;
}

}  // namespace fleetmap::registration
