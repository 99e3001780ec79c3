#pragma once

#include <Eigen/Core>
#include <random>

namespace fleetmap::graph::testing {

/// Errors of an EKF of GPS, gyro and wheels that knows its models exactly, second by second, and their
/// covariance. GPS is white and a drift; without it the filter reckons, its heading off by a growing angle.
class SimulatedFilter {
 public:
  static constexpr int kStates = 8;  ///< east, north, up, heading, gyro bias, drift of GPS (three)
  using State = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  SimulatedFilter(double gps_sigma, double gps_correlation_time, double reckoning, std::mt19937& random);

  /// A second during which the robot moves by `moved` in ENU, and then a fix.
  void step(const Eigen::Vector3d& moved, bool fix);

  Eigen::Vector3d position_error() const { return error_.head<3>(); }
  double heading_error() const { return error_(3); }
  Eigen::Matrix4d covariance() const;

 private:
  double gauss(double sigma);
  void correct();

  double sigma_, time_, reckoning_;
  std::mt19937& random_;
  State error_;
  Covariance P_;
};

}  // namespace fleetmap::graph::testing
