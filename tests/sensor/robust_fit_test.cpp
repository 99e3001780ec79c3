#include "robust_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "normalised_errors.hpp"

namespace fleetmap::sensor {
namespace {

/// y = a + b t with noise of 0.1 that is averaged over `correlated` neighbours.
FitProblem line(std::uint64_t seed, Eigen::Index correlated, bool outliers) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 0.1);
  Eigen::MatrixXd y(1, 300);
  std::vector<double> noise;
  for (Eigen::Index k = 0; k < y.cols() + correlated; ++k) noise.push_back(normal(random));
  for (Eigen::Index k = 0; k < y.cols(); ++k) {
    y(0, k) = 1.0 + 2.0 * static_cast<double>(k) / 300.0;
    for (Eigen::Index other = 0; other < correlated; ++other)
      y(0, k) += noise[static_cast<std::size_t>(k + other)] / std::sqrt(static_cast<double>(correlated));
    if (outliers && k % 10 == 0) y(0, k) += 50.0;
  }
  FitProblem problem;
  problem.residuals = [y](const Eigen::VectorXd& x) {
    Eigen::MatrixXd e(1, y.cols());
    for (Eigen::Index k = 0; k < y.cols(); ++k)
      e(0, k) = x[0] + x[1] * static_cast<double>(k) / 300.0 - y(0, k);
    return e;
  };
  problem.group_of_row = {0};
  problem.min_noise = {1e-6};
  problem.start = Eigen::VectorXd::Zero(2);
  problem.prior_sigma = Eigen::VectorXd::Constant(2, 100.0);
  problem.correlated_steps = static_cast<std::size_t>(3 * correlated);
  return problem;
}

double rms_of_normalised_errors(Eigen::Index correlated, bool outliers) {
  NormalisedErrors errors;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const FitResult fit = robust_fit(line(seed, correlated, outliers));
    errors.add(fit.parameters[0] - 1.0, std::sqrt(fit.covariance(0, 0)));
    errors.add(fit.parameters[1] - 2.0, std::sqrt(fit.covariance(1, 1)));
  }
  return errors.rms();
}

TEST(RobustFit, StatesSigmasThatItsErrorsHave) {
  EXPECT_NEAR(rms_of_normalised_errors(1, false), 1.0, 0.25);
  EXPECT_NEAR(rms_of_normalised_errors(6, false), 1.15, 0.35) << "correlated errors";
}

TEST(RobustFit, IgnoresOutliersAndEstimatesTheNoise) {
  EXPECT_NEAR(rms_of_normalised_errors(1, true), 1.0, 0.25);
  EXPECT_NEAR(robust_fit(line(1, 1, true)).noise.front(), 0.1, 0.02);
}

TEST(RobustFit, AParameterWithoutEffectKeepsItsPrior) {
  FitProblem problem = line(1, 1, false);
  problem.start = Eigen::Vector3d(0.0, 0.0, 7.0);
  problem.prior_sigma = Eigen::Vector3d(100.0, 100.0, 5.0);
  const FitResult fit = robust_fit(problem);
  EXPECT_NEAR(fit.parameters[2], 7.0, 1e-6);
  EXPECT_NEAR(std::sqrt(fit.covariance(2, 2)), 5.0, 1e-3);
}

}  // namespace
}  // namespace fleetmap::sensor
