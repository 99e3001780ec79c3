#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace fleetmap::sensor {

/// A least-squares problem over the steps of a drive. Rows of one noise group share a standard deviation,
/// which the fit estimates from its residuals.
struct FitProblem {
  /// Residuals of all steps at the given parameters: rows x steps, always of one size.
  std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> residuals;
  std::vector<std::size_t> group_of_row;
  std::vector<double> min_noise;  ///< of each group, 1 sigma
  Eigen::VectorXd start;
  Eigen::VectorXd prior_sigma;  ///< about `start`; wide: it only keeps what the drive does not excite finite
  std::size_t correlated_steps = 1;  ///< so many steps later the errors are independent
};

struct FitResult {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;
  std::vector<double> noise;  ///< of each group, 1 sigma
  double misfit = 0.0;        ///< mean logarithm of the noise over rows; compares starts of one problem
};

/// Iteratively reweighted Levenberg-Marquardt with Cauchy weights; noise by the median absolute residual. The
/// covariance is that of Newey and West (Econometrica 1987), so that errors that are correlated over
/// neighbouring steps, as those of overlapping windows and of a LiDAR's map are, do not count as independent.
FitResult robust_fit(const FitProblem& problem);

}  // namespace fleetmap::sensor
