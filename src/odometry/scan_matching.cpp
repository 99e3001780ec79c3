#include "scan_matching.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fleetmap/geometry/symmetric.hpp"
#include "square.hpp"

namespace fleetmap::odometry {
namespace {

constexpr double kStepTranslation = 5e-4;  // m, a smaller step ends the iteration
constexpr double kStepRotation = 2e-5;     // rad
constexpr double kAnnealing = 0.4;         // shrinkage of the kernel's slack in each iteration
constexpr double kFinalSlack = 0.02;       // m
/// Plane points that are used while the slack shrinks: a subset suffices until the last iteration.
constexpr std::size_t kEnoughPlanes = 600;
constexpr std::size_t kLongestStride = 4;
/// Pseudo-observations of the assumed variance in the a posteriori variance, which a few distances alone
/// would estimate badly.
constexpr double kAssumedDistances = 10.0;
/// A direction is degenerate if its information is within this factor of the spurious information of noisy
/// normals ...
constexpr double kSpuriousFactor = 6.0;
/// ... or below this share of a direction that all surfaces face.
constexpr double kMinShare = 5e-5;
/// A direction is weak if its information is within this factor, because noisy normals may be the larger part
/// of it.
constexpr double kWeakFactor = 40.0;
constexpr double kLevel = 0.7;             // upward part of the normal of what lies level, at least
constexpr std::size_t kFeatureBlock = 16;  // features whose windows are fetched together

double longest_time(const std::vector<FeaturePoint>& points, double longest) {
  for (const FeaturePoint& p : points) longest = std::max(longest, std::abs(static_cast<double>(p.time)));
  return longest;
}

/// Information of the points if the map may be distorted within every sweep by a velocity e of these standard
/// deviations (m/s, rad/s): a point fired at s moves with d_pose + s (d_twist + e), and e is marginalised.
/// Otherwise the velocity would be measured against the map's own distortion, which has no anchor, and both
/// would drift away from the motion between the poses.
NormalEquations with_distorted_map(const NormalEquations& points, double speed, double turn_rate) {
  Vector6d known;
  known << Eigen::Vector3d::Constant(1.0 / square(speed)), Eigen::Vector3d::Constant(1.0 / square(turn_rate));
  const Eigen::Matrix<double, 12, 6> coupling = points.H.rightCols<6>();
  Matrix6d of_distortion = points.H.bottomRightCorner<6, 6>();
  of_distortion.diagonal() += known;
  const Eigen::LDLT<Matrix6d> factor(of_distortion);
  NormalEquations result;
  result.H = points.H - coupling * factor.solve(coupling.transpose());
  result.H = (0.5 * (result.H + result.H.transpose())).eval();
  result.g = points.g - coupling * factor.solve(points.g.tail<6>());
  return result;
}

/// Removes the information along the degenerate directions, of the pose and of the velocity.
void remove_degenerate(const MatchResult& result, NormalEquations& equations) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(1.0 / result.range);
  const auto V = result.degenerate_directions.leftCols(result.degenerate_count);
  const Matrix6d keep =
      scale.asDiagonal() * (Matrix6d::Identity() - V * V.transpose()) * scale.cwiseInverse().asDiagonal();
  Matrix12d K = Matrix12d::Zero();
  K.topLeftCorner<6, 6>() = K.bottomRightCorner<6, 6>() = keep;
  equations.H = K.transpose() * equations.H * K;
  equations.g = K.transpose() * equations.g;
}

}  // namespace

ScanMatcher::ScanMatcher(const LoamConfig& config) : config_(config) {}

MatchResult ScanMatcher::align(const std::vector<FeaturePoint>& planes,
                               const std::vector<FeaturePoint>& edges, LocalMap& map,
                               const MotionPrior& prior, const MotionState& start, double initial_error) {
  MatchResult result;
  result.state = start;
  result.speed_measured = prior.has_forward_speed();
  result.turn_rate_measured = prior.has_gyro_rate() || prior.has_yaw_rate();
  lookups_.assign(planes.size(), {});
  const std::size_t some = std::clamp<std::size_t>(planes.size() / kEnoughPlanes, 1, kLongestStride);
  half_span_ = longest_time(edges, longest_time(planes, 1e-6));
  const double distortion_turn_rate =
      prior.has_gyro_rate() ? config_.gyro_noise : config_.map_distortion_turn_rate;
  double slack = initial_error;
  for (result.iterations = 1; result.iterations <= config_.max_iterations; ++result.iterations) {
    const bool last = slack <= kFinalSlack || result.iterations == config_.max_iterations;
    linearise(planes, edges, map, result.state, slack, last ? 1 : some);
    NormalEquations lidar = collect();
    find_degeneracy(lidar.H, result);
    lidar.H /= config_.information_deflation;
    lidar.g /= config_.information_deflation;
    lidar = with_distorted_map(lidar, config_.map_distortion_speed, distortion_turn_rate);
    const NormalEquations known = prior.linearised(result.state);
    if (result.degenerate_count > 0) remove_degenerate(result, lidar);
    const Vector12d step = -(lidar.H + known.H).ldlt().solve(lidar.g + known.g);
    if (!step.allFinite()) break;
    result.state.T_odom_base = result.state.T_odom_base * se3_exp(step.head<6>());
    result.state.twist += step.tail<6>();
    result.state.turn_acceleration = prior.turn_acceleration(result.state.twist);
    result.lidar_information = lidar.H;
    result.prior_information = known.H;
    result.prior_gradient = known.g + known.H * step;
    if (slack <= kFinalSlack && step.head<3>().norm() < kStepTranslation &&
        step.segment<3>(3).norm() < kStepRotation) {
      result.converged = true;
      break;
    }
    slack = std::max(slack * kAnnealing, 0.99 * kFinalSlack);
  }
  result.state.T_odom_base.linear() =
      Eigen::Quaterniond(result.state.T_odom_base.linear()).normalized().toRotationMatrix();
  fill_statistics(result);
  return result;
}

void ScanMatcher::fill_statistics(MatchResult& result) const {
  result.planes = sums_.planes;
  result.edges = sums_.edges;
  result.inlier_fraction =
      static_cast<double>(sums_.inliers) / static_cast<double>(std::max<std::size_t>(1, sums_.points));
  result.upright = sums_.upright;
  result.upright_inliers = sums_.upright_inliers;
  result.residual_variance =
      (sums_.inlier_normalised + kAssumedDistances) / (sums_.inlier_dimensions + kAssumedDistances);
  result.rms = std::sqrt(sums_.inlier_square / static_cast<double>(std::max<std::size_t>(1, sums_.inliers)));
}

/// The state at which the features are linearised, and the constants of their weights.
struct ScanMatcher::Linearisation {
  Linearisation(const LoamConfig& config, const MotionState& state, double half_span_, double slack_,
                std::size_t stride_)
      : motion(state.twist, state.turn_acceleration),
        R(state.T_odom_base.linear()),
        t(state.T_odom_base.translation()),
        sensor(R * config.T_base_lidar.translation() + t),
        half_span(half_span_),
        bins_per_second(kTimeBins / (2.0 * half_span_)),
        return_variance(square(config.range_noise)),
        edge_variance(square(config.edge_noise)),
        slack(slack_),
        stride(stride_) {}

  Eigen::Vector3d in_base(const FeaturePoint& feature) const {
    return motion.at_reference(feature.position, feature.time).cast<double>();
  }
  std::size_t bin_at(double time) const {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>((time + half_span) * bins_per_second), 0, kTimeBins - 1));
  }

  SweepMotion motion;
  Eigen::Matrix3d R;  ///< of T_odom_base
  Eigen::Vector3d t, sensor;
  double half_span, bins_per_second;
  double return_variance, edge_variance;
  double slack;
  std::size_t stride;
};

void ScanMatcher::linearise(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                            LocalMap& map, const MotionState& state, double slack, std::size_t stride) {
  for (TimeBin& bin : bins_) {
    bin.H.fill(0.0);
    bin.g.setZero();
  }
  sums_ = {};
  const Linearisation at(config_, state, half_span_, slack, stride);
  add_planes(at, planes, map);
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    const Eigen::Vector3d at_base = at.in_base(edges[i]), at_map = at.R * at_base + at.t;
    add_feature(at, edges[i], at_base, at_map, map.edge_at(at_map), true);
  }
}

void ScanMatcher::add_planes(const Linearisation& at, const std::vector<FeaturePoint>& planes,
                             LocalMap& map) {
  std::array<Eigen::Vector3d, kFeatureBlock> p, q, unknown;  // base_link, map frame
  for (std::size_t begin = 0; begin < planes.size(); begin += kFeatureBlock * at.stride) {
    const std::size_t count = std::min(kFeatureBlock, (planes.size() - begin + at.stride - 1) / at.stride);
    std::size_t unknowns = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k * at.stride;
      p[k] = at.in_base(planes[i]);
      q[k] = at.R * p[k] + at.t;
      const CellKey cell = map.cell_of(q[k]);
      if (lookups_[i].plane != nullptr && lookups_[i].cell == cell) continue;
      lookups_[i] = {cell, nullptr};
      unknown[unknowns++] = q[k];
    }
    map.fetch_ahead(std::span(unknown).first(unknowns));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k * at.stride;
      const Surface* known = lookups_[i].plane;
      const Surface* surface = known != nullptr ? known : map.surface_at(q[k], at.sensor);
      if (surface != nullptr && surface->shape == Shape::kPlane) lookups_[i].plane = surface;
      add_feature(at, planes[i], p[k], q[k], surface, false);
    }
  }
}

void ScanMatcher::add_feature(const Linearisation& at, const FeaturePoint& feature, const Eigen::Vector3d& p,
                              const Eigen::Vector3d& q, const Surface* surface, bool edge) {
  if (surface == nullptr) return;
  const bool plane = surface->shape == Shape::kPlane;
  const Eigen::Vector3d offset = q - surface->mean;
  const Eigen::Vector3d direction = surface->direction.cast<double>();
  const double distance2 = offset.squaredNorm();
  const double variance = (edge ? at.edge_variance + square(feature.noise) : at.return_variance) +
                          surface->thickness + distance2 * surface->angle_variance;
  const double along = direction.dot(offset);
  const double residual2 = plane ? along * along : std::max(0.0, distance2 - along * along);
  // Geman-McClure; the slack lets far surfaces pull while the state is still off.
  const double kernel = 9.0 * variance + at.slack * at.slack;
  const auto share = static_cast<double>(at.stride);  // each feature stands for so many
  const double weight = share * square(kernel / (kernel + residual2)) / variance;
  TimeBin& bin = bins_[at.bin_at(feature.time)];
  if (plane) {
    add_row(bin, p, at.R.transpose() * direction, along, weight);
    sums_.spurious += weight * surface->angle_variance;
  } else {
    const Eigen::Vector3d u = direction.unitOrthogonal();
    const Eigen::Vector3d v = direction.cross(u);
    add_row(bin, p, at.R.transpose() * u, u.dot(offset), weight);
    add_row(bin, p, at.R.transpose() * v, v.dot(offset), weight);
  }
  sums_.weight += weight;
  sums_.range += weight * p.norm();
  ++sums_.points;
  const bool upright = !plane || std::abs(direction.z()) < kLevel;
  sums_.upright += upright;
  ++(edge ? sums_.edges : sums_.planes);
  if (residual2 < 9.0 * variance) {
    ++sums_.inliers;
    sums_.upright_inliers += upright;
    sums_.inlier_square += residual2;
    sums_.inlier_normalised += residual2 / variance;
    sums_.inlier_dimensions += plane ? 1.0 : 2.0;
  }
}

void ScanMatcher::add_row(TimeBin& bin, const Eigen::Vector3d& p, const Eigen::Vector3d& normal_base,
                          double residual, double weight) {
  const Eigen::Vector3d torque = p.cross(normal_base);
  const double J[6] = {normal_base.x(), normal_base.y(), normal_base.z(), torque.x(), torque.y(), torque.z()};
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    const double wj = weight * J[i];
    bin.g[i] += wj * residual;
    for (int j = i; j < 6; ++j) bin.H[k++] += wj * J[j];
  }
}

/// A point fired s seconds after the reference instant moves with d_pose + s d_twist.
NormalEquations ScanMatcher::collect() const {
  NormalEquations total;
  for (int b = 0; b < kTimeBins; ++b) {
    const TimeBin& bin = bins_[static_cast<std::size_t>(b)];
    const double s = ((b + 0.5) / kTimeBins * 2.0 - 1.0) * half_span_;
    Matrix6d A;
    std::size_t k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) A(i, j) = A(j, i) = bin.H[k++];
    }
    total.H.topLeftCorner<6, 6>() += A;
    total.H.topRightCorner<6, 6>() += s * A;
    total.H.bottomRightCorner<6, 6>() += s * s * A;
    total.g.head<6>() += bin.g;
    total.g.tail<6>() += s * bin.g;
  }
  total.H.bottomLeftCorner<6, 6>() = total.H.topRightCorner<6, 6>().transpose();
  return total;
}

void ScanMatcher::find_degeneracy(const Matrix12d& H, MatchResult& result) const {
  const double weight = std::max(1.0, sums_.weight);
  const double range = std::max(1e-3, sums_.range / weight);
  Vector6d scale;
  scale << 1, 1, 1, 1 / range, 1 / range, 1 / range;
  const Matrix6d share = scale.asDiagonal() * H.topLeftCorner<6, 6>() * scale.asDiagonal() / weight;
  const SymmetricEigen eigen = eigen_of_symmetric(share);
  const double limit = kMinShare + kSpuriousFactor * sums_.spurious / weight;
  result.range = range;
  result.degenerate_count = static_cast<int>((eigen.values.array() < limit).count());
  const double weak = kMinShare + kWeakFactor * sums_.spurious / weight;
  result.weak_count = static_cast<int>((eigen.values.array() < weak).count()) - result.degenerate_count;
  result.degenerate_directions = eigen.vectors;
}

}  // namespace fleetmap::odometry
