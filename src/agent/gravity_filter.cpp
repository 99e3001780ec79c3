#include "fleetmap/agent/gravity_filter.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::agent {
namespace {

constexpr double kBlock = 10.0;           // s; longer than a bend lasts
constexpr double kOdometryTilt = 1.2e-8;  // rad^2/s, random walk of the odometry frame: 0.85 mrad a minute
constexpr double kOffset = 5e-3;          // rad, 1 sigma, of mount and accelerometer
constexpr double kOffsetWalk = 1e-9;      // rad^2/s: 0.8 mrad in ten minutes
constexpr double kFirstVariance = 1e-4;   // rad^2, of a block's mean until innovations are there
constexpr int kRemembered = 30;           // blocks that the estimated variance goes back
constexpr double kMinVariance = 2.5e-7;   // rad^2, of a block's mean
constexpr double kIndependent = 60.0;     // s

}  // namespace

void GravityFilter::add(const Eigen::Vector3d& up_in_base, const Pose& T_odom_base, Stamp stamp) {
  const Eigen::Vector3d up = T_odom_base.linear() * up_in_base.normalized();
  if (!up.allFinite() || (block_.samples > 0 && stamp <= block_.last)) return;
  if (block_.samples == 0) block_.first = stamp;
  block_.last = stamp;
  block_.tilt += up.head<2>();
  block_.R_odom_base += T_odom_base.linear().topLeftCorner<2, 2>();
  ++block_.samples;
  if (to_seconds(stamp - block_.first) < kBlock) return;
  block_.tilt /= block_.samples;
  block_.R_odom_base /= block_.samples;
  update(block_);
  block_ = {};
}

void GravityFilter::update(const Block& block) {
  if (!updated_) {
    P_ = Eigen::Vector4d(1.0, 1.0, kOffset * kOffset, kOffset * kOffset).asDiagonal();
    block_variance_ = kFirstVariance;
  } else {
    const double seconds = to_seconds(block.last - *updated_);
    P_.diagonal() += seconds * Eigen::Vector4d(kOdometryTilt, kOdometryTilt, kOffsetWalk, kOffsetWalk);
  }
  Eigen::Matrix<double, 2, 4> H;
  H << Eigen::Matrix2d::Identity(), block.R_odom_base;
  const Eigen::Vector2d innovation = block.tilt - H * x_;
  if (updated_) {
    // The innovation holds the filter's own uncertainty as well, so this errs on the large side.
    const double weight = 1.0 / std::min(++blocks_ + 1, kRemembered);
    block_variance_ += weight * (0.5 * innovation.squaredNorm() - block_variance_);
  }
  updated_ = block.last;
  const double noise = std::max(block_variance_, kMinVariance);
  const Eigen::Matrix2d S = H * P_ * H.transpose() + noise * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 4, 2> K = P_ * H.transpose() * S.inverse();
  x_ += K * innovation;
  const Eigen::Matrix4d A = Eigen::Matrix4d::Identity() - K * H;
  P_ = A * P_ * A.transpose() + noise * K * K.transpose();
}

Eigen::Vector3d GravityFilter::up_in_base(const Pose& T_odom_base) const {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  if (updated_) {
    tilt = x_.head<2>();
  } else if (block_.samples > 0) {
    tilt = block_.tilt / block_.samples;
  }
  const Eigen::Vector3d up(tilt.x(), tilt.y(), std::sqrt(std::max(0.0, 1.0 - tilt.squaredNorm())));
  return (T_odom_base.linear().transpose() * up).normalized();
}

std::optional<double> GravityFilter::variance() const {
  if (!updated_) return std::nullopt;
  const double variance = 0.5 * P_.topLeftCorner<2, 2>().trace();
  // Errors live as long as it takes the odometry's random walk to grow to them.
  const double lasts = variance / kOdometryTilt;  // s
  return variance * std::max(1.0, lasts / kIndependent);
}

GlobalPose levelled(const GlobalPose& G, const Eigen::Vector3d& up_in_base,
                    const std::optional<double>& variance) {
  const Eigen::Vector3d up = G.q_enu_base.conjugate() * Eigen::Vector3d::UnitZ();
  GlobalPose turned = G;
  turned.q_enu_base = (G.q_enu_base * minimal_rotation(up_in_base, up)).normalized();
  if (variance) {
    turned.covariance.middleRows<2>(3).setZero();
    turned.covariance.middleCols<2>(3).setZero();
    turned.covariance.diagonal().segment<2>(3).setConstant(*variance);
  }
  return turned;
}

}  // namespace fleetmap::agent
