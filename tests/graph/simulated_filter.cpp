#include "simulated_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace fleetmap::graph::testing {

SimulatedFilter::SimulatedFilter(double gps_sigma, double gps_correlation_time, double reckoning,
                                 std::mt19937& random)
    : sigma_(gps_sigma), time_(gps_correlation_time), reckoning_(reckoning), random_(random) {
  State sigma;
  sigma << 1e2, 1e2, 1e2, 0.05, 3e-3, 1.0, 1.0, 1.0;
  P_ = sigma.cwiseAbs2().asDiagonal();
  for (int k = 0; k < kStates; ++k) error_(k) = gauss(sigma(k));
}

void SimulatedFilter::step(const Eigen::Vector3d& moved, bool fix) {
  Covariance F = Covariance::Identity();
  F(0, 3) = -moved.y();
  F(1, 3) = moved.x();
  F(3, 4) = 1.0;
  const double keep = std::exp(-1.0 / time_);
  F.diagonal().segment<3>(5).setConstant(keep);
  State noise;
  noise << Eigen::Vector3d::Constant(reckoning_), 2e-3, 1e-5,
      Eigen::Vector3d::Constant(std::sqrt(1.0 - keep * keep));
  error_ = F * error_;
  for (int k = 0; k < kStates; ++k) error_(k) += gauss(noise(k));
  P_ = F * P_ * F.transpose() + Covariance(noise.cwiseAbs2().asDiagonal());
  if (fix) correct();
}

Eigen::Matrix4d SimulatedFilter::covariance() const { return P_.topLeftCorner<4, 4>(); }

double SimulatedFilter::gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

void SimulatedFilter::correct() {
  Eigen::Matrix<double, 3, kStates> H = Eigen::Matrix<double, 3, kStates>::Zero();
  H.leftCols<3>().setIdentity();
  H.middleCols<3>(5).diagonal().setConstant(std::sqrt(0.9) * sigma_);
  const double white = 0.1 * sigma_ * sigma_;
  const Eigen::Matrix3d S = H * P_ * H.transpose() + white * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, kStates, 3> K = P_ * H.transpose() * S.llt().solve(Eigen::Matrix3d::Identity());
  Eigen::Vector3d residual = -(H * error_);
  for (int axis = 0; axis < 3; ++axis) residual(axis) += gauss(std::sqrt(white));
  error_ += K * residual;
  const Covariance rest = Covariance::Identity() - K * H;
  P_ = rest * P_ * rest.transpose() + white * K * K.transpose();
}

}  // namespace fleetmap::graph::testing
