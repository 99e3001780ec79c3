#include "fleetmap/odometry/pose_uncertainty.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::odometry {
namespace {

constexpr double kKept = 0.95;       // of a prior's misfit, from scan to scan
constexpr double kAssumed = 10.0;    // dimensions in which it is taken to be as stated
constexpr double kChangeGain = 0.1;  // of the changes of the turn rate: over a second

double square(double value) { return value * value; }

}  // namespace

void PriorMisfit::add(double squares, double dimensions) {
  squares_ = kKept * squares_ + squares;
  dimensions_ = kKept * dimensions_ + dimensions;
}

double PriorMisfit::variance() const { return (squares_ + kAssumed) / (dimensions_ + kAssumed); }

PoseUncertainty::PoseUncertainty(LoamConfig config) : config_(std::move(config)) {}

void PoseUncertainty::start() {
  covariance_.setZero();
  covariance_.diagonal().segment<3>(6).setConstant(square(config_.initial_speed));
  covariance_.diagonal().tail<3>().setConstant(square(config_.initial_turn_rate));
  last_noise_.setZero();
}

void PoseUncertainty::map_restarted() {
  covariance_.topRows<6>().setZero();
  covariance_.leftCols<6>().setZero();
  last_noise_.setZero();
}

void PoseUncertainty::turn_changed(const Eigen::Vector3d& change) {
  turn_change_ += kChangeGain * (change.cwiseAbs2() - turn_change_);
}

PoseUncertainty::Stated PoseUncertainty::state(const Matched& scan) {
  const Matrix12d error = error_at_reference(scan);
  // At the stamp the pose is T exp(s twist), s seconds from the reference instant: d = Ad d_pose + s d_twist.
  Eigen::Matrix<double, 6, 12> M;
  M << adjoint(scan.T_reference_stamp.inverse()), -scan.reference_offset * Matrix6d::Identity();
  const Matrix6d at_stamp = M * error * M.transpose();
  Stated stated{0.5 * (at_stamp + at_stamp.transpose()), growth(scan, error.topLeftCorner<6, 6>())};
  // A line laid through a parabola over the sweep's half length h is off by a (s^2/2 - h^2/6) at s.
  const double bow = 0.5 * square(scan.reference_offset) - square(scan.half_sweep) / 6.0;
  stated.pose_noise.diagonal().tail<3>() +=
      bow * bow * scan.turn_acceleration_variance.value_or(turn_change_);
  return stated;
}

/// How far the points move the translation away from the prior, against how far it was taken to be off: a
/// robot that drives smoothly knows its motion better than the prior's accelerations say, one that is shaken
/// less well. Rotation only without a gyro: a gyro's bias turns all scans alike, so that points and gyro
/// agree from scan to scan says less.
void PoseUncertainty::judge_prior(const MatchResult& match, const Matrix12d& covariance, bool gyro) {
  const Vector12d d = match.prior_information.ldlt().solve(match.prior_gradient);
  if (!d.allFinite()) return;
  // Where the points tell nothing the motion follows the prior, which says nothing of the prior.
  const Vector12d told =
      Vector12d::Ones() - (match.prior_information * covariance).diagonal().cwiseMin(1.0).cwiseMax(0.0);
  const Vector12d misfit = d.cwiseProduct(match.prior_information * d);
  // What it shares with rotation can make a part of a square negative.
  translation_misfit_.add(std::max(0.0, misfit.head<3>().sum() + misfit.segment<3>(6).sum()),
                          told.head<3>().sum() + told.segment<3>(6).sum());
  if (gyro) return;
  rotation_misfit_.add(std::max(0.0, misfit.segment<3>(3).sum() + misfit.tail<3>().sum()),
                       told.segment<3>(3).sum() + told.tail<3>().sum());
}

/// Of pose and velocity at the scan's reference instant.
Matrix12d PoseUncertainty::error_at_reference(const Matched& scan) {
  const MatchResult& match = scan.match;
  Matrix12d information = match.prior_information;
  if (!scan.lost) information += match.lidar_information;
  const Matrix12d at_reference = information.ldlt().solve(Matrix12d::Identity());
  remember(at_reference);

  Matrix12d scatter = match.prior_information;
  if (!scan.lost) {
    // The points err as far as they lie off their surfaces, and the prior as far as the points moved the
    // motion away from it, not as both were weighed.
    const bool gyro = scan.turn_acceleration_variance.has_value();
    judge_prior(match, at_reference, gyro);
    Vector12d scale = Vector12d::Ones();
    scale.head<3>().setConstant(std::sqrt(translation_misfit_.variance()));
    if (!gyro) scale.segment<3>(3).setConstant(std::sqrt(rotation_misfit_.variance()));
    scale.tail<6>() = scale.head<6>();
    scatter = scale.asDiagonal() * match.prior_information * scale.asDiagonal();
    scatter += match.residual_variance * match.lidar_information;
  }
  const Matrix12d error = at_reference * scatter * at_reference;
  return 0.5 * (error + error.transpose());
}

/// What stays unknown is unknown at the next scan, too; but no velocity is known less than at the start.
void PoseUncertainty::remember(const Matrix12d& at_reference) {
  Vector12d scale = Vector12d::Ones();
  for (int i = 6; i < 12; ++i) {
    const double most = square(i < 9 ? config_.initial_speed : config_.initial_turn_rate);
    if (at_reference(i, i) > most) scale[i] = std::sqrt(most / at_reference(i, i));
  }
  const Matrix12d capped = scale.asDiagonal() * at_reference * scale.asDiagonal();
  covariance_ = 0.5 * (capped + capped.transpose());
}

/// New ground enters the map at poses that err as `noise` says, that of the reference instant, for which a
/// scan is matched: so the map drifts with the way. Along degenerate directions, and when lost, the map does
/// not hold the motion at all, and what a scan adds to their error stays in the map.
Matrix6d PoseUncertainty::growth(const Matched& scan, const Matrix6d& noise) {
  const MatchResult& match = scan.match;
  const double way = scan.T_before_now.translation().norm() + so3_log(scan.T_before_now.linear()).norm();
  Matrix6d growth = way * config_.drift_share * noise;
  growth.diagonal().head<3>().array() += way * config_.drift_translation * config_.drift_translation;
  growth.diagonal().tail<3>().array() += way * config_.drift_rotation * config_.drift_rotation;
  const Matrix6d A = adjoint(scan.T_before_now.inverse());
  const Matrix6d added = noise - A * last_noise_ * A.transpose();
  last_noise_ = noise;
  const Matrix6d axes = scan.lost ? Matrix6d(Matrix6d::Identity()) : match.degenerate_directions;
  for (int i = 0; i < (scan.lost ? 6 : match.degenerate_count); ++i) {
    const Vector6d axis = axes.col(i);
    growth += std::max(0.0, axis.dot(added * axis)) * axis * axis.transpose();
  }
  return growth;
}

}  // namespace fleetmap::odometry
