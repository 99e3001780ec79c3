#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "fleetmap/geometry/se3.hpp"

/// Do errors keep to what their covariances promise?
namespace fleetmap::eval {

/// An error of 1 to 6 dimensions and the covariance that was stated for it.
struct StatedError {
  Eigen::VectorXd error;
  Eigen::MatrixXd covariance;
};

/// The error of an estimate in its right tangent, T_true exp(e) = T_estimate: [m, rad]. The frame of
/// covariances of alignments and odometry.
Vector6d tangent_error(const Pose& T_true, const Pose& T_estimate);

/// Normalised errors squared (NEES), e^T C^-1 e. With honest Gaussian covariances its mean is the number of
/// dimensions, so `mean` is 1; 4 says that errors are twice as large as promised.
struct Consistency {
  std::size_t count = 0;
  std::size_t refused = 0;       ///< not finite, or the covariance is not positive definite; not counted
  std::size_t dimensions = 0;    ///< of each error
  double mean = 0.0;             ///< of NEES over dimensions
  double median = 0.0;           ///< of NEES over dimensions; 0.4 to 0.9 when honest: see expected_median
  double expected_median = 0.0;  ///< of honest Gaussian errors
  double within_95 = 0.0;        ///< share inside the ellipsoid that should hold 95 %
  std::vector<double> axes;      ///< RMS of each dimension's error over its sigma; 1 when honest
};
/// All of the same dimensions, else those that differ from the first are refused.
Consistency consistency(std::span<const StatedError> errors);

/// Statistics of a list of magnitudes; all 0 if it is empty.
struct Spread {
  std::size_t count = 0;
  double rms = 0.0, p50 = 0.0, p90 = 0.0, p95 = 0.0, p99 = 0.0, max = 0.0;
};
Spread spread(std::vector<double> values);

}  // namespace fleetmap::eval
