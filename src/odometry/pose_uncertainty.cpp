#include "pose_uncertainty.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "square.hpp"

namespace fleetmap::odometry {
namespace {

constexpr double kKept = 0.95;             // of a prior's misfit, from scan to scan
constexpr double kAssumed = 10.0;          // dimensions in which it is taken to be as stated
constexpr double kChangeGain = 0.1;        // of the changes of the turn rate: over a second
constexpr double kLargeUnheldShare = 0.3;  // share of the map near that is as bad as all of it
constexpr double kStrange = 1.0;   // variance of a prior's misfit: no robot drives so where all is held
constexpr double kMapTurn = 1.0;   // rad, the same for a LiDAR that looks ahead
constexpr double kMapReach = 5.0;  // m of way on which most of the map that is seen is replaced

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
  hold();
}

void PoseUncertainty::map_restarted() {
  covariance_.topRows<6>().setZero();
  covariance_.leftCols<6>().setZero();
  hold();
}

void PoseUncertainty::hold() {
  last_noise_.setZero();
  unheld_stated_.setZero();
  unheld_share_ = slid_ = 0.0;
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

/// Compares the correction of the translation by the points with the prior's variance: the motion of a robot
/// that drives smoothly is predicted better than the prior's accelerations state, that of a shaken one less
/// well. The rotation is used only without a gyro, because a gyro's bias turns all scans alike, so the
/// agreement of points and gyro between scans shows less.
void PoseUncertainty::update_prior_misfit(const MatchResult& match, const Matrix12d& covariance, bool gyro) {
  const Vector12d d = match.prior_information.ldlt().solve(match.prior_gradient);
  if (!d.allFinite()) return;
  // Unmeasured components follow the prior, so their misfit says nothing about it and is not counted.
  const Vector12d measured =
      Vector12d::Ones() - (match.prior_information * covariance).diagonal().cwiseMin(1.0).cwiseMax(0.0);
  const Vector12d misfit = d.cwiseProduct(match.prior_information * d);
  // The cross terms with the rotation can make a part of the square negative.
  translation_misfit_.add(std::max(0.0, misfit.head<3>().sum() + misfit.segment<3>(6).sum()),
                          measured.head<3>().sum() + measured.segment<3>(6).sum());
  if (gyro) return;
  rotation_misfit_.add(std::max(0.0, misfit.segment<3>(3).sum() + misfit.tail<3>().sum()),
                       measured.segment<3>(3).sum() + measured.tail<3>().sum());
}

/// Covariance of pose and velocity at the scan's reference instant.
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
    update_prior_misfit(match, at_reference, gyro);
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

/// Keeps the covariance for the next scan. The velocity's is bounded by its value at the start.
void PoseUncertainty::remember(const Matrix12d& at_reference) {
  Vector12d scale = Vector12d::Ones();
  for (int i = 6; i < 12; ++i) {
    const double max_variance = square(i < 9 ? config_.initial_speed : config_.initial_turn_rate);
    if (at_reference(i, i) > max_variance) scale[i] = std::sqrt(max_variance / at_reference(i, i));
  }
  const Matrix12d capped = scale.asDiagonal() * at_reference * scale.asDiagonal();
  covariance_ = 0.5 * (capped + capped.transpose());
}

/// Growth of the drift by one scan. New surfaces enter the map with the error `noise` of the pose at the
/// reference instant, so the map drifts with the distance. While the scan is lost, the map does not constrain
/// the motion, and the added error stays in the map.
Matrix6d PoseUncertainty::growth(const Matched& scan, const Matrix6d& noise) {
  const MatchResult& match = scan.match;
  const double way = scan.T_before_now.translation().norm() + so3_log(scan.T_before_now.linear()).norm();
  const Matrix6d A = adjoint(scan.T_before_now.inverse());
  const Matrix6d added = noise - A * last_noise_ * A.transpose();
  last_noise_ = noise;
  unheld_stated_ = (A * unheld_stated_ * A.transpose()).eval();
  const bool slides = match.weak_count > 0 && translation_misfit_.variance() > kStrange;
  const bool unheld = scan.lost || match.degenerate_count > 0 || slides;
  const double renewed = scan.T_before_now.translation().norm() / kMapReach +
                         so3_log(scan.T_before_now.linear()).norm() / kMapTurn;
  unheld_share_ += std::min(1.0, renewed) * ((unheld ? 1.0 : 0.0) - unheld_share_);
  if (!unheld) unheld_stated_.setZero();

  Matrix6d growth = Matrix6d::Zero();
  growth.diagonal().head<3>().array() += way * config_.drift_translation * config_.drift_translation;
  growth.diagonal().tail<3>().array() += way * config_.drift_rotation * config_.drift_rotation;
  if (scan.lost) {
    const Matrix6d stays = added.diagonal().cwiseMax(0.0).asDiagonal();
    unheld_stated_ += stays;
    return growth + way * config_.drift_share * noise + stays;
  }
  Vector6d scale = Vector6d::Ones();  // of the degenerate directions: [m, m, m, and rotation times range]
  scale.tail<3>().setConstant(1.0 / match.range);
  const auto V = match.degenerate_directions.leftCols(match.degenerate_count);
  const Matrix6d held =
      scale.asDiagonal() * (Matrix6d::Identity() - V * V.transpose()) * scale.cwiseInverse().asDiagonal();
  return growth + way * config_.drift_share * held * noise * held.transpose() + growth_unheld(match, noise) +
         growth_sliding(match, way);
}

/// Growth along degenerate directions. There a pose has the error of its prior, and all surfaces that enter
/// the map share it. The next constrained scan corrects it, except for the share of the map that was built at
/// such poses.
Matrix6d PoseUncertainty::growth_unheld(const MatchResult& match, const Matrix6d& noise) {
  const double stays = square(std::min(1.0, unheld_share_ / kLargeUnheldShare));
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(match.range);
  Matrix6d growth = Matrix6d::Zero();
  for (int i = 0; i < match.degenerate_count; ++i) {
    const Vector6d across = scale.asDiagonal() * Vector6d(match.degenerate_directions.col(i));
    const Vector6d axis = scale.cwiseInverse().asDiagonal() * Vector6d(match.degenerate_directions.col(i));
    const double unstated =
        stays * across.dot(noise * across) - across.dot((unheld_stated_ + growth) * across);
    growth += std::max(0.0, unstated) * axis * axis.transpose();
  }
  unheld_stated_ += growth;
  return growth;
}

/// Growth by sliding. A map that was built mostly of scans that it did not constrain may have slid together
/// with them, so a scan that it seems to constrain again is no evidence, nor are directions that are weakly
/// constrained. The same holds where scans are weakly constrained and their motion is unlike the prior's: a
/// warped map holds its scans well. Only wheels and a gyro measure whether they slid.
Matrix6d PoseUncertainty::growth_sliding(const MatchResult& match, double way) {
  if (match.degenerate_count > 0) sliding_ = match;
  if (unheld_share_ < kLargeUnheldShare) {
    slid_ = 0.0;
    return Matrix6d::Zero();
  }
  const double before = std::exchange(slid_, slid_ + way);
  Vector6d scale;
  scale.head<3>().setConstant(match.speed_measured ? 0.0 : 1.0);
  scale.tail<3>().setConstant(match.turn_rate_measured ? 0.0 : 1.0 / sliding_.range);
  Matrix6d directions = Matrix6d::Zero();
  if (match.degenerate_count == 0) {
    const auto V = sliding_.degenerate_directions.leftCols(sliding_.degenerate_count);
    directions = V * V.transpose();
  }
  const auto W = match.degenerate_directions.middleCols(match.degenerate_count, match.weak_count);
  directions += W * W.transpose();
  return (square(slid_) - square(before)) * (scale.asDiagonal() * directions * scale.asDiagonal()).eval();
}

}  // namespace fleetmap::odometry
